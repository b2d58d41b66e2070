/** Where a machine is put by hand: by arrow keys or by dragging, never off the map. */
import type { SiteMap } from "@/api/types";
import type { Point } from "@/map/plane/projection";

export const STEP_M = 0.1;
export const LEAP_M = 1;
const WAYS: Readonly<Record<string, Point>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** The point one step further in the key's direction (metres, y up), a short or a long one; null for any other key. */
export function nudge(
  [x, y]: Point,
  key: string,
  leap: boolean,
  [short, long]: Point = [STEP_M, LEAP_M],
): Point | null {
  const direction = WAYS[key];
  if (!direction) return null;
  const step = leap ? long : short;
  return [x + direction[0] * step, y + direction[1] * step];
}

export const isSame = (a: Point, b: Point): boolean => a[0] === b[0] && a[1] === b[1];

/** Where a map lies. */
export type Extent = Pick<SiteMap, "width" | "height" | "resolution_m" | "origin">;

/** The nearest point on the map, to the centimetre. */
export function onMap([x, y]: Point, map: Extent): Point {
  const { origin, resolution_m: cell } = map;
  return [between(x, origin.x, origin.x + map.width * cell), between(y, origin.y, origin.y + map.height * cell)];
}

function between(value: number, least: number, most: number): number {
  return Math.round(Math.min(most, Math.max(least, value)) * 100) / 100;
}
