/** The shadows of what stands, as shapes on the floor: the sun does not move, so they are part of the floor's picture. */
import type { MapObstacle } from "@/map/floor/floor";
import type { Solid } from "./solids";
import type { SceneDevice } from "./types";

export type Point = readonly [x: number, y: number];

/** Where the light comes from, seen from the floor; metres east, up and south. */
export const SUN = [-0.3, 0.8, 0.4] as const;
/** How far a shadow reaches for each metre of height: east and north. */
const REACH: Point = [-SUN[0] / SUN[1], SUN[2] / SUN[1]];

/** What stands on a convex piece of floor, from one height to another, metres of the map. */
export interface Prism {
  readonly corners: readonly Point[];
  readonly from_m: number;
  readonly to_m: number;
}

const cross = ([ox, oy]: Point, [ax, ay]: Point, [bx, by]: Point) => (ax - ox) * (by - oy) - (ay - oy) * (bx - ox);

function half(points: readonly Point[]): Point[] {
  const kept: Point[] = [];
  for (const point of points) {
    for (;;) {
      const [before, last] = kept.slice(-2);
      if (!before || !last || cross(before, last, point) > 0) break;
      kept.pop();
    }
    kept.push(point);
  }
  return kept.slice(0, -1);
}

/** The smallest convex shape around points, counterclockwise. */
function hullOf(points: readonly Point[]): Point[] {
  const sorted = [...points].sort(([ax, ay], [bx, by]) => ax - bx || ay - by);
  return [...half(sorted), ...half(sorted.reverse())];
}

/** The shape on the floor that lies in a prism's shadow, counterclockwise, so that many are filled as one. */
export function shadowOf({ corners, from_m, to_m }: Prism): Point[] {
  const moved = (height_m: number) =>
    corners.map(([x, y]): Point => [x + REACH[0] * height_m, y + REACH[1] * height_m]);
  return hullOf([...moved(from_m), ...moved(to_m)]);
}

/** A machine's solids where it stands; what lies flat on the floor casts none. */
export function prismsOf({ location }: SceneDevice, solids: readonly Solid[]): Prism[] {
  const [cos, sin] = [Math.cos(location.theta), Math.sin(location.theta)];
  return solids.flatMap(({ at: [x, up, z], box, can, turn }) => {
    if (turn) return []; // they lie on something wider
    const [wide, high, deep] = box ?? [2 * (can?.radius ?? 0), can?.height ?? 0, 2 * (can?.radius ?? 0)];
    if (up + high / 2 < 0.05) return [];
    const corners = [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ].map(([east = 0, south = 0]): Point => {
      const [along, across] = [x + (east * wide) / 2, -(z + (south * deep) / 2)];
      return [location.x + along * cos - across * sin, location.y + along * sin + across * cos];
    });
    return [{ corners, from_m: Math.max(0, up - high / 2), to_m: up + high / 2 }];
  });
}

export const OBSTACLE_HEIGHT_M = 0.7;
const SIDES = 8;

/** A round thing that stands on the floor. */
export function prismOfObstacle({ x, y, size_m }: Pick<MapObstacle, "x" | "y" | "size_m">): Prism {
  const corners = Array.from({ length: SIDES }, (_, side): Point => {
    const angle = (side * 2 * Math.PI) / SIDES;
    return [x + (Math.cos(angle) * size_m) / 2, y + (Math.sin(angle) * size_m) / 2];
  });
  return { corners, from_m: 0, to_m: OBSTACLE_HEIGHT_M };
}
