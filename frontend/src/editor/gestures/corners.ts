/** Lists of corners changed one at a time; pure. */
import { toCentimetre } from "../model/clipping";
import type { PixelPoint } from "@/map/routePath";
import { nearestOn } from "../scene/geometry";
import type { Position } from "../model/edits";

export function pushed(points: readonly Position[], at: number, [dx, dy]: Position): Position[] {
  return points.map((point, index) =>
    index === at ? [toCentimetre(point[0] + dx), toCentimetre(point[1] + dy)] : point,
  );
}

export function withCorner(points: readonly Position[], at: number, corner: Position): Position[] {
  return [...points.slice(0, at), corner, ...points.slice(at)];
}

export function withoutCorner(points: readonly Position[], at: number): Position[] {
  return points.filter((_, index) => index !== at);
}

/** Which leg of a way a point lies nearest to; 0 is the first. */
export function nearestLeg(way: readonly PixelPoint[], to: PixelPoint): number {
  const far = way.slice(1).map((end, index) => nearestOn([way[index] ?? end, end], to)?.off ?? Infinity);
  return Math.max(0, far.indexOf(Math.min(...far)));
}
