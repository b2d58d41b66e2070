/** Rehearsals and their results. */

import type { Compiled, ProgramDocument } from "./programs";
import type { StepStatus } from "./runs";
import type { Point, Scalar, WaitReason } from "./values";

export type RehearsalStatus = "queued" | "running" | "done" | "failed";

export interface Rehearsal {
  id: string;
  status: RehearsalStatus;
  /** 0 to 1. */
  progress: number;
  result: RehearsalResult | null;
  document: ProgramDocument;
  compiled: Compiled;
}

export interface NearMiss {
  t: number;
  a: string;
  b: string;
  distance_m: number;
  x: number;
  y: number;
}

/** A line of a rehearsal's log; older ones have no code. */
export interface LogLine {
  t: number;
  step: string;
  device: string;
  text: string;
  code?: string;
  args?: Record<string, Scalar>;
}

export interface RehearsalError {
  t: number;
  step: string;
  kind: string;
  message: string;
  code?: string;
  args?: Record<string, Scalar>;
}

export interface RehearsalResult {
  ok: boolean;
  duration_s: number;
  errors: RehearsalError[];
  robots: Record<string, { distance_m: number; busy_s: number; wait_s: number; battery: number }>;
  machines: Record<string, { busy_s: number }>;
  near_misses: NearMiss[];
  collisions: NearMiss[];
  waits: { t: number; duration_s: number; robot: string; reason: string; why?: WaitReason }[];
  steps: {
    step: string;
    count: number;
    robot: string | null;
    device: string | null;
    started_s: number;
    ended_s: number | null;
    status: StepStatus;
  }[];
  frames: { dt_s: number; robots: Record<string, [number, number, number][]> };
  carrying: Record<string, [number, Record<string, number>][]>;
  machine_states: Record<string, [number, boolean][]>;
  properties: Record<string, [number, string, Scalar][]>;
  routes: { t: number; robot: string; path: Point[] }[];
  log: LogLine[];
}
