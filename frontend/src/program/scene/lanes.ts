/** Keeps routes that run along the same line apart: each gets a lane of its own. */
import type { PixelPoint } from "@/map/plane/paths";

const LANE = 15;
const NEAR = 11;
const TRIES = [0, 1, -1, 2, -2, 3, -3];

interface Leg {
  readonly flat: boolean;
  readonly line: number;
  readonly from: number;
  readonly to: number;
}

/** Which ends of a route may slide along the machine that they touch. */
export interface FreeEnds {
  readonly start: boolean;
  readonly end: boolean;
}

const FIXED: FreeEnds = { start: false, end: false };

/** Legs that lie already, found by the line that they lie on. */
class TakenLegs {
  readonly #byLine = new Map<string, Leg[]>();

  add(leg: Leg): void {
    const key = TakenLegs.#key(leg, 0);
    const same = this.#byLine.get(key) ?? [];
    same.push(leg);
    this.#byLine.set(key, same);
  }

  isOn(leg: Leg): boolean {
    return [-1, 0, 1].some((by) => this.#byLine.get(TakenLegs.#key(leg, by))?.some((other) => collide(leg, other)));
  }

  static #key({ flat, line }: Leg, by: number): string {
    return `${flat ? "flat" : "steep"}${Math.floor(line / NEAR) + by}`;
  }
}

/** The same routes, in the same order, with their legs moved aside where another lies already. */
export function separateLanes(
  routes: readonly (readonly PixelPoint[])[],
  free: readonly FreeEnds[] = [],
): PixelPoint[][] {
  const taken = new TakenLegs();
  return routes.map((route, at) => {
    const points = route.map((point) => ({ ...point }));
    const ends = free[at] ?? FIXED;
    for (let index = 1; index < points.length; index += 1) {
      const first = index === 1 && !ends.start;
      const last = index === points.length - 1 && !ends.end;
      if (!first && !last) moveLeg(points, index, taken);
    }
    for (let index = 1; index < points.length; index += 1) {
      const leg = legOf(points[index - 1], points[index]);
      if (leg) taken.add(leg);
    }
    return points;
  });
}

/** Moves the leg before `index` aside; the legs on both sides grow or shrink with it. */
function moveLeg(points: { x: number; y: number }[], index: number, taken: TakenLegs): void {
  const [a, b] = [points[index - 1], points[index]];
  const leg = legOf(a, b);
  if (!a || !b || !leg) return;
  const shift = TRIES.find((lane) => !taken.isOn({ ...leg, line: leg.line + lane * LANE }));
  if (!shift) return;
  if (leg.flat) [a.y, b.y] = [a.y + shift * LANE, b.y + shift * LANE];
  else [a.x, b.x] = [a.x + shift * LANE, b.x + shift * LANE];
}

function legOf(a: PixelPoint | undefined, b: PixelPoint | undefined): Leg | null {
  if (!a || !b) return null;
  if (Math.abs(a.y - b.y) < 1 && Math.abs(a.x - b.x) > 1)
    return { flat: true, line: a.y, from: Math.min(a.x, b.x), to: Math.max(a.x, b.x) };
  if (Math.abs(a.x - b.x) < 1 && Math.abs(a.y - b.y) > 1)
    return { flat: false, line: a.x, from: Math.min(a.y, b.y), to: Math.max(a.y, b.y) };
  return null;
}

function collide(one: Leg, other: Leg): boolean {
  if (one.flat !== other.flat || Math.abs(one.line - other.line) > NEAR) return false;
  return Math.min(one.to, other.to) - Math.max(one.from, other.from) > 18;
}
