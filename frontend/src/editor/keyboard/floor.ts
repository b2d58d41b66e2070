/** A point of the floor moved by keys, and said in words; pure. */
import { isRobot } from "@/map/devices/device";
import type { MapPlace } from "@/map/floor/floor";
import type { Point } from "@/map/plane/projection";
import type { SiteDevice } from "@/program/surroundings";

export interface Landmark {
  readonly name: string;
  readonly at: Point;
}

const WAYS: Readonly<Record<string, Point>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const COARSE_M = 1;
const FINE_M = 0.1;

/** One metre in the arrow's direction, with Shift ten centimetres; null for any other key. */
export function stepped(at: Point, key: string, fine: boolean, bounds: Bounds | null): Point | null {
  const way = WAYS[key];
  if (!way) return null;
  const by = fine ? FINE_M : COARSE_M;
  const [x, y] = [at[0] + way[0] * by, at[1] + way[1] * by];
  const clamp = (value: number, least: number, most: number) => Math.max(least, Math.min(most, value));
  const kept: Point = bounds ? [clamp(x, bounds.left, bounds.right), clamp(y, bounds.bottom, bounds.top)] : [x, y];
  return [toCentimetres(kept[0]), toCentimetres(kept[1])];
}

/** Metres. */
export interface Bounds {
  readonly left: number;
  readonly right: number;
  readonly bottom: number;
  readonly top: number;
}

function toCentimetres(value: number): number {
  return Math.round(value * 100) / 100;
}

/** What can be jumped to: machines, then named places, each by its name. */
export function landmarksOf(devices: readonly SiteDevice[], places: readonly MapPlace[]): readonly Landmark[] {
  const machines = devices.filter((each) => !isRobot(each));
  const byName = (one: Landmark, other: Landmark) => one.name.localeCompare(other.name);
  return [
    ...machines.map(({ name, location }): Landmark => ({ name, at: [location.x, location.y] })).sort(byName),
    ...places.map(({ name, x, y }): Landmark => ({ name, at: [x, y] })).sort(byName),
  ];
}

/** The next one behind the one jumped to last whose name begins with the letter; the first such one behind the last. */
export function byLetter(landmarks: readonly Landmark[], last: number, letter: string): number | null {
  const begins = (each: Landmark | undefined) => each?.name.toLowerCase().startsWith(letter.toLowerCase()) ?? false;
  const behind = landmarks.findIndex((each, index) => index > last && begins(each));
  const found = behind >= 0 ? behind : landmarks.findIndex(begins);
  return found >= 0 ? found : null;
}

/** The landmark that is nearest, how far it is, and on which side of it the point lies. */
export function nearest(
  at: Point,
  landmarks: readonly Landmark[],
): {
  readonly name: string;
  readonly metres: number;
  readonly side: "at" | "left" | "right" | "above" | "below";
} | null {
  let best: { landmark: Landmark; metres: number } | null = null;
  for (const landmark of landmarks) {
    const metres = Math.hypot(landmark.at[0] - at[0], landmark.at[1] - at[1]);
    if (!best || metres < best.metres) best = { landmark, metres };
  }
  if (!best) return null;
  const [dx, dy] = [at[0] - best.landmark.at[0], at[1] - best.landmark.at[1]];
  const across = dx < 0 ? "left" : "right";
  const along = dy < 0 ? "below" : "above";
  const side = best.metres < 0.05 ? "at" : Math.abs(dx) >= Math.abs(dy) ? across : along;
  return { name: best.landmark.name, metres: Math.round(best.metres * 10) / 10, side };
}
