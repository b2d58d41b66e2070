/** Reading a rehearsal's recording at any moment. */

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
  const poses = frames.robots[robot];
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

/** The way a robot drove in the `seconds` before a time, thinned to points at least 5 cm apart. */
export function trailBefore(frames: Frames, robot: string, t_s: number, seconds: number): [number, number][] {
  const poses = frames.robots[robot] ?? [];
  const first = Math.max(0, Math.floor((t_s - seconds) / frames.dt_s));
  const last = Math.min(poses.length - 1, Math.floor(t_s / frames.dt_s));
  const trail: [number, number][] = [];
  for (let index = first; index <= last; index += 1) {
    const pose = poses[index];
    const before = trail[trail.length - 1];
    if (pose && (!before || Math.hypot(pose[0] - before[0], pose[1] - before[1]) >= 0.05))
      trail.push([pose[0], pose[1]]);
  }
  return trail;
}
