import { expect, test } from "vitest";
import type { TestCoverage } from "@/api/types";
import { figuresOf, liftsOf, marksOf, missedOf, wordsOf } from "./coverage";

const CONSTRUCTS: TestCoverage["constructs"] = [
  { step: "late", line: 9, ways: { reached: 0, true: 0, false: 0 } },
  { step: "choice", line: 3, ways: { reached: 2, true: 2, false: 0 } },
  { step: "guard", line: 5, ways: { reached: 1, "catch timed_out": 0, limit: 1 } },
];

test("steps and ways are counted apart", () => {
  expect(figuresOf(CONSTRUCTS)).toEqual({ steps: { taken: 2, all: 3 }, ways: { taken: 2, all: 6 } });
});

test("what no test took stands in the order of the script, and of what was never reached that alone", () => {
  expect(missedOf(CONSTRUCTS)).toEqual([
    { step: "choice", way: "false" },
    { step: "guard", way: "catch timed_out" },
    { step: "late", way: "reached" },
  ]);
});

test("a catch is told with the kinds that it takes", () => {
  const t = (key: string, values?: Record<string, unknown>) => `${key} ${JSON.stringify(values ?? {})}`;
  expect(wordsOf("catch timed_out rejected", t)).toBe('tests.missed.catch_of {"kinds":"timed_out, rejected"}');
  expect(wordsOf("catch", t)).toBe("tests.missed.catch {}");
  expect(wordsOf("time out", t)).toBe("tests.missed.time out {}");
});

test("each step has how many tests came there, and what of it none took", () => {
  expect(marksOf(CONSTRUCTS)).toEqual([
    { step: "late", tests: 0, missed: ["reached"] },
    { step: "choice", tests: 2, missed: ["false"] },
    { step: "guard", tests: 1, missed: ["catch timed_out"] },
  ]);
});

test("marks that would lie on each other stand above each other, where they cover least", () => {
  const at = (x: number, y: number, width = 36) => ({ x, y, width });
  expect(liftsOf([at(0, 100), at(10, 100), at(20, 100), at(200, 100)])).toEqual([0, 19, 38, 0]);
  expect(liftsOf([at(0, 100), at(-30, 81), at(0, 62), at(0, 100, 160)])).toEqual([0, 0, 0, 19]);
});
