import { vi } from "vitest";
import type { RunSummary } from "@/api/types";
import { isOpen } from "@/live/messages";

/** A run that has finished, as the server tells of it. */
export const run = (number: number, more: Partial<RunSummary> = {}) =>
  ({
    id: `run-${number}`,
    number,
    program: { id: `p-${number}`, name: `Program ${number}` },
    status: "finished",
    started_at: "2026-11-30T08:00:00Z",
    ended_at: null,
    not_before: null,
    deadline: null,
    steps: {},
    reason: "",
    cause: null,
    started_by: null,
    ...more,
  }) as RunSummary;

/** More runs that are over than a list has in one part, the newest first: 65 down to 6. */
export const FINISHED = Array.from({ length: 60 }, (_, index) => run(65 - index));

/** What makes a run wait for its time. */
export const PLANNED = {
  status: "pending",
  started_at: null,
  not_before: new Date(Date.now() + 7 * 86_400_000).toISOString(),
} as const;

/**
 * A server with these runs, the newest 50 of them or all that are not over, and these programs.
 * Gives the addresses that were asked for.
 */
export function serveRuns(runs: readonly RunSummary[], programs: readonly unknown[] = []): string[] {
  const asked: string[] = [];
  const answer = (path: string) => {
    if (path.includes("/runs?state=open")) return runs.filter(isOpen);
    if (/\/runs(\?|$)/.test(path)) return runs.slice(0, 50);
    if (path.includes("/runs/")) return { ...run(1), compiled: null };
    return path.includes("/programs") ? programs : [];
  };
  vi.stubGlobal("fetch", (path: string) => {
    asked.push(path);
    return Promise.resolve(Response.json(answer(path)));
  });
  return asked;
}
