import { expect, test } from "vitest";
import type { Program, RunSummary } from "@/api/types";
import { begun, planned } from "./uses";

const PROGRAMS = [{ id: "paint" }] as Program[];

function run(number: number, status: string, began: string | null, program = "paint"): RunSummary {
  return { number, status, started_at: began, program: { id: program } } as RunSummary;
}

const RUNS = [
  run(2, "running", "2026-11-29T08:00:00Z"),
  run(3, "paused", "2026-11-29T08:00:00Z"),
  run(4, "running", "2026-11-29T08:00:00Z", "another"),
  run(5, "pending", null),
  run(6, "paused", null),
];

test("of the runs that are not over those that have begun are under way", () => {
  expect(begun(RUNS, PROGRAMS).map(({ number }) => number)).toEqual([2, 3]);
});

test("runs that wait for their time have not begun, also those that are paused until then", () => {
  expect(planned(RUNS, PROGRAMS).map(({ number }) => number)).toEqual([5, 6]);
});
