/** Where names stand so that none covers another: at their things, else a little above, else nowhere. Pure. */

export interface Name {
  /** Where its middle would best be, and how large it is; pixels. */
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

const GAP = 3;
/** So many heights of its own at most is a name moved. */
const STOREYS = 2.6;

const meets = (a: Name, b: Name) =>
  Math.abs(a.x - b.x) < (a.width + b.width) / 2 + GAP && Math.abs(a.y - b.y) < (a.height + b.height) / 2 + GAP;

/** Just above all that a name would cover where it is. */
const above = (name: Name, covered: readonly Name[]) =>
  Math.min(...covered.map((other) => other.y - (other.height + name.height) / 2 - GAP));

/**
 * How far each name is moved up, in pixels, so that it covers none before it in the list; null where that would be too
 * far from what it names: it is not shown then.
 */
export function placesOf(names: readonly Name[]): (number | null)[] {
  const taken: Name[] = [];
  return names.map((name) => {
    let here = name;
    while (name.y - here.y <= STOREYS * name.height) {
      const covered = taken.filter((other) => meets(here, other));
      if (covered.length === 0) {
        taken.push(here);
        return name.y - here.y;
      }
      here = { ...name, y: above(here, covered) };
    }
    return null;
  });
}
