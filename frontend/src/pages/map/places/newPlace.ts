/** Where a place goes that nobody has pointed at. */
import { cellAt, type FloorPlan } from "@/map/floor/floor";
import type { Point } from "@/map/plane/projection";

/** The free point that is nearest to the middle of the map, in metres; the middle itself where nothing is free. */
export function freeMiddle(map: FloorPlan): Point {
  const middle: Point = [
    map.origin.x + (map.width * map.resolution_m) / 2,
    map.origin.y + (map.height * map.resolution_m) / 2,
  ];
  let [best, least] = [middle, Infinity];
  for (let row = 0; row < map.height; row += 1)
    for (let column = 0; column < map.width; column += 1) {
      const at: Point = [
        map.origin.x + (column + 0.5) * map.resolution_m,
        map.origin.y + (row + 0.5) * map.resolution_m,
      ];
      const far = (at[0] - middle[0]) ** 2 + (at[1] - middle[1]) ** 2;
      if (far < least && cellAt(map, at) === 0) [best, least] = [at, far];
    }
  return [Math.round(best[0] * 100) / 100, Math.round(best[1] * 100) / 100];
}
