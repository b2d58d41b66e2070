/** Runs and their journals. */

import type { Compiled, ProgramDocument } from "./programs";
import type { Cause, WaitReason } from "./values";

export type RunStatus = "pending" | "running" | "paused" | "finished" | "failed" | "cancelled";

export type StepStatus = "waiting" | "running" | "done" | "failed" | "skipped";

export interface RunStep {
  status: StepStatus;
  started_at: string | null;
  ended_at: string | null;
  robot: string | null;
  wait: string | null;
  why?: WaitReason | null;
  count: number;
}

/** A run as lists and live messages have it. */
export interface RunSummary {
  id: string;
  number: number;
  program: { id: string; name: string };
  version: number | null;
  site: string;
  status: RunStatus;
  reason: string;
  cause: Cause | null;
  started_at: string | null;
  ended_at: string | null;
  started_by: { name: string; initials: string } | string | null;
  steps: Record<string, RunStep>;
  roles: Record<string, string>;
}

export interface Run extends RunSummary {
  document: ProgramDocument;
  compiled: Compiled;
}

export interface RunEvent {
  seq: number;
  at: string;
  t_s: number;
  kind: string;
  step: string;
  device: string;
  robot: string;
  text: string;
  cause: Cause | null;
  code: string;
  args: Record<string, unknown>;
}
