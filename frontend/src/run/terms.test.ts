import { expect, test } from "vitest";
import type { RunSummary } from "@/api/types";
import { isLate, isPlanned } from "./terms";

const AT = Date.parse("2026-11-23T12:00:00Z");
const run = (more: Partial<RunSummary>) =>
  ({ status: "pending", not_before: null, deadline: null, ended_at: null, ...more }) as RunSummary;

test("a run is planned until its time, and not when it is called off or held", () => {
  const not_before = "2026-11-23T12:00:01Z";
  expect(isPlanned(run({ not_before }), AT)).toBe(true);
  expect(isPlanned(run({ not_before }), AT + 1000)).toBe(false);
  expect(isPlanned(run({ not_before, status: "cancelled" }), AT)).toBe(false);
  expect(isPlanned(run({}), AT)).toBe(false);
});

test("a run is late when its deadline is past before it is over", () => {
  const deadline = "2026-11-23T11:00:00Z";
  expect(isLate(run({ deadline, status: "running" }), AT)).toBe(true);
  expect(isLate(run({ deadline, status: "running" }), Date.parse(deadline))).toBe(false);
  expect(isLate(run({ deadline, status: "finished", ended_at: "2026-11-23T10:59:00Z" }), AT)).toBe(false);
  expect(isLate(run({ deadline, status: "failed", ended_at: "2026-11-23T11:01:00Z" }), AT)).toBe(true);
  expect(isLate(run({ deadline, status: "cancelled", ended_at: "2026-11-23T11:01:00Z" }), AT)).toBe(false);
  expect(isLate(run({ status: "running" }), AT)).toBe(false);
});
