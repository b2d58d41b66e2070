import { expect, it } from "vitest";
import type { Compiled, RunStep } from "@/api/types";
import { currentStep, outerProgress, spentSeconds, stepAt, stepLines } from "./stepList";

const compiled: Compiled = {
  revision: 1,
  script: "",
  lines: [],
  numbers: { a: "1", b: "1a", c: "2" },
  diagnostics: [],
  added_moves: [],
  order: ["a", "b", "c"],
  depth: { a: 0, b: 1, c: 0 },
};
const step = (status: RunStep["status"], started: string | null, ended: string | null = null): RunStep => ({
  status,
  started_at: started,
  ended_at: ended,
  robot: null,
  wait: null,
  count: 1,
});

it("lists steps in reading order and those that have not begun as waiting", () => {
  const lines = stepLines(compiled, { a: step("done", "2026-01-01T00:00:00Z", "2026-01-01T00:00:09Z") });
  expect(lines.map((line) => [line.number, line.status])).toEqual([
    ["1", "done"],
    ["1a", "waiting"],
    ["2", "waiting"],
  ]);
  expect(outerProgress(lines)).toEqual({ done: 1, all: 2 });
});

it("takes the innermost running step as the current one", () => {
  const lines = stepLines(compiled, {
    a: step("running", "2026-01-01T00:00:00Z"),
    b: step("running", "2026-01-01T00:00:01Z"),
  });
  expect(currentStep(lines)?.step).toBe("b");
  expect(currentStep(stepLines(compiled, {}))).toBeNull();
});

it("counts the time to the end, or to now", () => {
  const now = Date.parse("2026-01-01T00:00:30Z");
  expect(spentSeconds(step("done", "2026-01-01T00:00:00Z", "2026-01-01T00:00:09Z"), now)).toBe(9);
  expect(spentSeconds(step("running", "2026-01-01T00:00:10Z"), now)).toBe(20);
  expect(spentSeconds(step("waiting", null), now)).toBeNull();
});

it("finds the innermost step that was carried out at a moment", () => {
  const times = (from: string | null, to: string | null = null) => step("done", from, to);
  const lines = stepLines(compiled, {
    a: times("2026-01-01T00:00:00Z", "2026-01-01T00:01:00Z"),
    b: times("2026-01-01T00:00:10Z", "2026-01-01T00:00:20Z"),
    c: times("2026-01-01T00:01:00Z"),
  });
  const at = (seconds: number) => stepAt(lines, Date.parse("2026-01-01T00:00:00Z") + seconds * 1000);
  expect([at(-1), at(5), at(15), at(30), at(90)]).toEqual([undefined, "a", "b", "a", "c"]);
});
