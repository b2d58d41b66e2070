/** Whether a run waits for its time, or is late. */
import type { RunSummary } from "@/api/types";

/** Whether a run waits for its time; `now` in milliseconds since 1970. */
export function isPlanned(run: RunSummary, now: number): boolean {
  return run.status === "pending" && run.not_before !== null && Date.parse(run.not_before) > now;
}

/** Whether a run was or is still not over at its deadline; one that never began is not late once it is called off. */
export function isLate(run: RunSummary, now: number): boolean {
  if (run.deadline === null || run.status === "cancelled") return false;
  return Date.parse(run.deadline) < (run.ended_at ? Date.parse(run.ended_at) : now);
}
