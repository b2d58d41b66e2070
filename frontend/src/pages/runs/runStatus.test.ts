import { expect, test } from "vitest";
import type { RunStatus, RunSummary } from "@/api/types";
import { joinRuns, lastRuns, secondsOfRun, statusOfRun, stepsDone, underWay } from "./runStatus";

const LATER = "2026-12-07T08:00:00Z";
const NOW = Date.parse("2026-11-30T08:00:00Z");
const run = (more: Partial<RunSummary> = {}) =>
  ({ id: "r", number: 1, program: { id: "p", name: "P" }, status: "running", steps: {}, ...more }) as RunSummary;
const step = (status: string) => ({ status }) as RunSummary["steps"][string];

test("each status has its sign", () => {
  const statuses: RunStatus[] = ["pending", "running", "paused", "finished", "failed", "cancelled"];
  const signs = statuses.map((status) => statusOfRun(run({ status })));
  expect(signs).toEqual(["idle", "busy", "waiting", "done", "error", "offline"]);
});

test("only steps that are done are counted", () => {
  const steps = { a: step("done"), b: step("skipped"), c: step("running"), d: step("failed"), e: step("waiting") };
  expect(stepsDone(run({ steps }))).toBe(1);
});

test("time runs from the start to the end, or to now", () => {
  const started_at = "2026-01-01T12:00:00Z";
  const now = Date.parse("2026-01-01T12:01:06Z");
  expect(secondsOfRun(run({ started_at: null }), now)).toBeNull();
  expect(secondsOfRun(run({ started_at, ended_at: null }), now)).toBe(66);
  expect(secondsOfRun(run({ started_at, ended_at: "2026-01-01T12:00:30Z" }), now)).toBe(30);
  expect(secondsOfRun(run({ started_at, ended_at: null }), Date.parse("2026-01-01T11:59:00Z"))).toBe(0);
});

test("the last run of a program is the one with the highest number", () => {
  const runs = [
    run({ id: "c", number: 3 }),
    run({ id: "b", number: 2 }),
    run({ id: "q", program: { id: "q", name: "" } }),
  ];
  const last = lastRuns(runs, NOW);
  expect([last.get("p")?.id, last.get("q")?.id, last.size]).toEqual(["c", "q", 2]);
});

test("the last run of a program is one that is under way, and none that waits for its time", () => {
  const runs = [
    run({ id: "d", number: 4, status: "pending", not_before: LATER }),
    run({ id: "c", number: 3, status: "finished", not_before: null }),
    run({ id: "b", number: 2, status: "running", not_before: null }),
    run({ id: "q", number: 1, status: "pending", not_before: LATER, program: { id: "q", name: "" } }),
  ];
  expect([...lastRuns(runs, NOW)].map(([program, { id }]) => [program, id])).toEqual([["p", "b"]]);
  expect(lastRuns(runs, Date.parse(LATER)).get("p")?.id).toBe("d");
});

test("a run that waits for its time is not under way", () => {
  const runs = [
    run({ id: "d", status: "pending", not_before: LATER }),
    run({ id: "c", status: "pending", not_before: null }),
    run({ id: "a", status: "paused", not_before: null }),
  ];
  expect(underWay(runs, NOW).map(({ id }) => id)).toEqual(["c", "a"]);
});

test("older runs come after the newest, and a run that is in both lists once, as the first has it", () => {
  const newest = [run({ id: "d", number: 4 }), run({ id: "c", number: 3 })];
  const kept = [run({ id: "c", number: 3, status: "failed" }), run({ id: "b", number: 2 })];
  const joined = joinRuns(newest, kept);
  expect(joined.map((each) => [each.number, each.status])).toEqual([
    [4, "running"],
    [3, "running"],
    [2, "running"],
  ]);
});
