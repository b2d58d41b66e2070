/** How much of a construct is shown at a zoom, and whether those in view are few enough to be elements. Pure. */

/** With its words; its number and icon; its colour and shape. */
export type LevelOfDetail = "full" | "icon" | "dot";

export function detailAt(zoom: number): LevelOfDetail {
  if (zoom < 0.35) return "dot";
  return zoom < 0.6 ? "icon" : "full";
}

/** So many constructs are elements at once; when they once are, a few more may be before they are painted. */
const MOST_NODES = 80;
const SPARE_NODES = 20;

/** Whether the constructs in view are elements that can be read and reached, and not only painted. */
export function areNear(zoom: number, inView: number, were: boolean): boolean {
  return detailAt(zoom) !== "dot" && inView <= MOST_NODES + (were ? SPARE_NODES : 0);
}

/** So many that are selected, held or carried are elements wherever they stand. */
export const MOST_HELD = 40;
