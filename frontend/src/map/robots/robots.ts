/** Live robots between two known poses, and the trail they leave. */
import type { Point } from "../plane/projection";
import type { DeviceStatus } from "@/api/types";

export interface Pose {
  readonly x: number;
  readonly y: number;
  readonly theta: number;
}

export interface TimedPose extends Pose {
  /** Milliseconds on any clock that does not jump. */
  readonly at: number;
}

/** A robot at one moment, as the layer draws it. */
export interface RobotView extends Pose {
  readonly id: string;
  readonly name: string;
  readonly status: DeviceStatus;
  /** One short line under the name. */
  readonly note?: string;
  readonly carrying?: boolean;
  /** The planned way, metres. */
  readonly route?: readonly Point[];
  /** The piece of it that is reserved, metres. */
  readonly reserved?: readonly Point[];
  /** Where its copy in the mirror is, while it is at work. */
  readonly copy?: Pose;
  /** Where the real robot stands that is simulated for a while. */
  readonly real?: Pose | null;
  /** Why it waits. */
  readonly wait?: string | null;
}

/** Asked once a frame for where everybody is; `now` as performance.now(). */
export type RobotSource = (now: number) => readonly RobotView[];

/** The pose between two messages, drawn one message late; never farther than the newest. */
export function interpolatePose(previous: TimedPose | null, current: TimedPose, now: number): Pose {
  if (!previous) return current;
  const span = current.at - previous.at;
  if (span <= 0 || span > 2000) return current;
  const part = Math.min(1, Math.max(0, (now - current.at) / span));
  return {
    x: previous.x + (current.x - previous.x) * part,
    y: previous.y + (current.y - previous.y) * part,
    theta: previous.theta + turn(previous.theta, current.theta) * part,
  };
}

/** The short way round from one angle to another, radians. */
export function turn(from: number, to: number): number {
  const around = (to - from) % (2 * Math.PI);
  if (around > Math.PI) return around - 2 * Math.PI;
  return around < -Math.PI ? around + 2 * Math.PI : around;
}

const TRAIL_MS = 30_000;
const TRAIL_STEP_M = 0.08;
/** Farther than any robot drives between two pictures: it was not seen meanwhile. */
const UNSEEN_M = 2;

export interface TrailPoint {
  readonly x: number;
  readonly y: number;
  /** From 1 (just now) to 0 (30 s ago). */
  readonly fresh: number;
  /** Whether the robot was seen on its way from the point before. */
  readonly seen: boolean;
}

/** Where each robot has been in the last 30 s. */
export class Trails {
  readonly #points = new Map<string, { x: number; y: number; at: number; seen: boolean }[]>();

  add(robot: RobotView, now: number): void {
    const points = this.#points.get(robot.id) ?? [];
    const last = points.at(-1);
    const driven = last ? Math.hypot(last.x - robot.x, last.y - robot.y) : Infinity;
    if (driven > TRAIL_STEP_M) points.push({ x: robot.x, y: robot.y, at: now, seen: driven < UNSEEN_M });
    this.#points.set(
      robot.id,
      points.filter((point) => now - point.at <= TRAIL_MS),
    );
  }

  /** Oldest first. */
  of(robot: string, now: number): readonly TrailPoint[] {
    return (this.#points.get(robot) ?? []).map((point) => ({
      x: point.x,
      y: point.y,
      seen: point.seen,
      fresh: 1 - (now - point.at) / TRAIL_MS,
    }));
  }
}

/** Nearer than this a robot and its copy are where they should be, and one covers the other. */
const APART_M = 0.15;

/** How far a robot and its copy are apart, metres; null while that is nothing to speak of. */
export function apartOf(copy: { x: number; y: number }, robot: { x: number; y: number }): number | null {
  const apart = Math.hypot(copy.x - robot.x, copy.y - robot.y);
  return apart < APART_M ? null : apart;
}
