/** Fast things that must not re-render anything: robots' last two poses, and readings of this session. */
import type { TimedPose } from "@/map/robots/robots";
import type { Device, Scalar } from "@/api/types";

export interface PosePair {
  readonly previous: TimedPose | null;
  readonly current: TimedPose;
}

export interface Reading {
  /** Milliseconds, as performance.now(). */
  readonly at: number;
  readonly value: Scalar;
}

const KEPT = 240;
const poses = new Map<string, PosePair>();
const readings = new Map<string, Reading[]>();

/** A robot's last two poses; undefined when it has not told any. */
export function poseOf(device: string): PosePair | undefined {
  return poses.get(device);
}

/** What a property has been since this page was opened, oldest first. */
export function readingsOf(device: string, property: string): readonly Reading[] {
  return readings.get(`${device} ${property}`) ?? [];
}

/** Keep what a device says about itself, at `now` milliseconds. */
export function recordDevice(change: Partial<Device> & { id: string }, now: number): void {
  if (change.location) recordPose(change.id, { ...change.location, at: now });
  for (const property of change.properties ?? [])
    if (property.value !== null) recordReading(`${change.id} ${property.name}`, { at: now, value: property.value });
}

function recordPose(device: string, pose: TimedPose): void {
  const before = poses.get(device)?.current;
  const moved = !before || before.x !== pose.x || before.y !== pose.y || before.theta !== pose.theta;
  if (moved) poses.set(device, { previous: before ?? null, current: pose });
}

function recordReading(key: string, reading: Reading): void {
  const list = readings.get(key) ?? [];
  const steady = list.at(-1)?.value === reading.value && list.at(-2)?.value === reading.value;
  if (steady) list.pop();
  list.push(reading);
  if (list.length > KEPT) list.shift();
  readings.set(key, list);
}

/** Forget everything; another site is looked at. */
export function forgetReadings(): void {
  poses.clear();
  readings.clear();
}
