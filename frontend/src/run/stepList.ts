/** The steps of a run in reading order, with their state and their time. Pure. */
import type { Compiled, RunStep, StepStatus, WaitReason } from "@/api/types";

export interface StepLine {
  step: string;
  number: string;
  depth: number;
  status: StepStatus;
  started_at: string | null;
  ended_at: string | null;
  wait: string | null;
  why?: WaitReason | null;
  robot: string | null;
  count: number;
}

/** Numbers of events, which are no part of the program's course. */
const EVENT = /^e\d/;
const NOT_YET: RunStep = { status: "waiting", started_at: null, ended_at: null, robot: null, wait: null, count: 0 };

export function stepLines(compiled: Compiled, steps: Record<string, RunStep>): StepLine[] {
  return compiled.order.map((step) => {
    const state = steps[step] ?? NOT_YET;
    return { ...state, step, number: compiled.numbers[step] ?? "", depth: compiled.depth[step] ?? 0 };
  });
}

/** The innermost step that is being carried out; of several, the one that began last. */
export function currentStep(lines: readonly StepLine[]): StepLine | null {
  const active = lines.filter((line) => (line.status === "running" || line.status === "waiting") && line.started_at);
  return (
    [...active].sort((a, b) => a.depth - b.depth || (a.started_at ?? "").localeCompare(b.started_at ?? "")).pop() ??
    null
  );
}

/** The innermost step that was last begun of those that were carried out at a moment, ms since 1970. */
export function stepAt(lines: readonly StepLine[], at: number): string | undefined {
  const then = lines.filter(
    ({ started_at, ended_at }) =>
      started_at !== null && Date.parse(started_at) <= at && (ended_at === null || at <= Date.parse(ended_at)),
  );
  const inner = (a: StepLine, b: StepLine) =>
    a.depth - b.depth || (a.started_at ?? "").localeCompare(b.started_at ?? "");
  return [...then].sort(inner).at(-1)?.step;
}

/** How many of the program's outer steps are over, and how many there are. */
export function outerProgress(lines: readonly StepLine[]): { done: number; all: number } {
  const outer = lines.filter((line) => line.depth === 0 && !EVENT.test(line.number));
  return { done: outer.filter((line) => line.status === "done").length, all: outer.length };
}

/** Seconds between two ISO times, up to `now` (ms since 1970) while it goes on; null before it began. */
export function spentSeconds(line: Pick<StepLine, "started_at" | "ended_at">, now: number): number | null {
  if (!line.started_at) return null;
  const end = line.ended_at ? Date.parse(line.ended_at) : now;
  return Math.max(0, (end - Date.parse(line.started_at)) / 1000);
}
