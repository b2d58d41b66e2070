/** Reading a rehearsal's recording at any moment. */
import { ownEntry } from "@/design/ownEntry";

export type PoseFrame = readonly [x: number, y: number, theta: number];

export interface Frames {
  dt_s: number;
  robots: Record<string, PoseFrame[]>;
}

/** The shorter way round from one angle to another. */
function turn(from: number, to: number): number {
  const difference = (to - from) % (2 * Math.PI);
  if (difference > Math.PI) return difference - 2 * Math.PI;
  return difference < -Math.PI ? difference + 2 * Math.PI : difference;
}

/** A robot's pose at a time, between the two recorded poses around it; null when nothing was recorded. */
export function poseAt(frames: Frames, robot: string, t_s: number): PoseFrame | null {
  const poses = ownEntry(frames.robots, robot);
  if (!poses || poses.length === 0) return null;
  const position = Math.min(Math.max(t_s / frames.dt_s, 0), poses.length - 1);
  const index = Math.floor(position);
  const from = poses[index];
  if (!from) return null;
  const to = poses[Math.min(index + 1, poses.length - 1)] ?? from;
  const part = position - index;
  return [
    from[0] + (to[0] - from[0]) * part,
    from[1] + (to[1] - from[1]) * part,
    from[2] + turn(from[2], to[2]) * part,
  ];
}

/** The last entry of a time-ordered list that is not later than `t_s`. */
export function latest<T extends readonly [number, ...unknown[]]>(
  entries: readonly T[] | undefined,
  t_s: number,
): T | null {
  if (!entries) return null;
  let low = 0;
  let high = entries.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    const entry = entries[middle];
    if (entry && entry[0] <= t_s) low = middle + 1;
    else high = middle;
  }
  return entries[low - 1] ?? null;
}

const STEP_M = 0.05;
const STRAIGHT_RAD = 0.05;

/** A path with a point only where it turns: points nearer than 5 cm, or within 3° straight on, are left out. */
export function straightened(path: Iterable<readonly number[]>): [number, number][] {
  const kept: [number, number][] = [];
  for (const [x = 0, y = 0] of path) {
    const [before, last] = [kept.at(-2), kept.at(-1)];
    if (last && Math.hypot(x - last[0], y - last[1]) < STEP_M) continue;
    if (before && last) {
      const heading = Math.atan2(last[1] - before[1], last[0] - before[0]);
      if (Math.abs(turn(heading, Math.atan2(y - last[1], x - last[0]))) < STRAIGHT_RAD) kept.pop();
    }
    kept.push([x, y]);
  }
  return kept;
}

/** The path that a robot drove in the `seconds` before a time. */
export function trailBefore(frames: Frames, robot: string, t_s: number, seconds: number): [number, number][] {
  const poses = ownEntry(frames.robots, robot) ?? [];
  const first = Math.max(0, Math.floor((t_s - seconds) / frames.dt_s));
  return straightened(poses.slice(first, Math.floor(t_s / frames.dt_s) + 1));
}
