/** A run in a list: how it stands, how far it is, how long it took. */
import type { RunStatus, RunSummary } from "@/api/types";
import type { StatusName } from "@/design/StatusGlyph";
import { isOpen } from "@/live/messages";
import { isPlanned } from "@/run/terms";

const STATUS: Readonly<Record<RunStatus, StatusName>> = {
  pending: "idle",
  running: "busy",
  paused: "waiting",
  finished: "done",
  failed: "error",
  cancelled: "offline",
};

export function statusOfRun(run: Pick<RunSummary, "status">): StatusName {
  return STATUS[run.status] ?? "idle";
}

/** Of the runs that are not over those that do not wait for their time; `now` in milliseconds since 1970. */
export function underWay(open: readonly RunSummary[], now: number): RunSummary[] {
  return open.filter((run) => !isPlanned(run, now));
}

/** How many steps are done; a list knows only of those that have begun, so not of how many. */
export function stepsDone(run: RunSummary): number {
  return Object.values(run.steps).filter((step) => step.status === "done").length;
}

/** Seconds from the start to the end, or to `now` (milliseconds since 1970); null before the start. */
export function secondsOfRun(run: RunSummary, now: number): number | null {
  if (!run.started_at) return null;
  const end = run.ended_at ? new Date(run.ended_at).getTime() : now;
  return Math.max(0, (end - new Date(run.started_at).getTime()) / 1000);
}

/** The newest run of each program, or the newest that is under way; one that waits for its time is none yet. */
export function lastRuns(runs: readonly RunSummary[], now: number): Map<string, RunSummary> {
  const last = new Map<string, RunSummary>();
  const begun = runs.filter((run) => !isPlanned(run, now));
  const order = (a: RunSummary, b: RunSummary) => Number(isOpen(a)) - Number(isOpen(b)) || a.number - b.number;
  for (const run of begun.sort(order)) last.set(run.program.id, run);
  return last;
}

/** Two lists of runs as one, the newest first; of a run that is in both the first list knows more. */
export function joinRuns(first: readonly RunSummary[], second: readonly RunSummary[]): RunSummary[] {
  const known = new Set(first.map((run) => run.id));
  return [...first, ...second.filter((run) => !known.has(run.id))].sort((a, b) => b.number - a.number);
}
