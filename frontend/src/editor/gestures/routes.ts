/** A planned way that people bend. */
import { toMetres } from "@/map/projection";
import { simplified, type PixelPoint } from "@/map/routePath";
import type { Position } from "../model/edits";

/** The bends of a way as it is planned; the middle of a straight one, so that there is one to drag. */
export function plannedBends(points: readonly PixelPoint[]): Position[] {
  const bends = simplified(points).slice(1, -1).map(toMetres);
  const [first, last] = [points[0], points.at(-1)];
  if (bends.length > 0 || !first || !last) return bends;
  return [toMetres({ x: (first.x + last.x) / 2, y: (first.y + last.y) / 2 })];
}
