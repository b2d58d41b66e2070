import { expect, test } from "vitest";
import { backOff } from "./connection";

test("each attempt waits twice as long as the one before", () => {
  expect([0, 1, 2, 3, 4].map((attempt) => backOff(attempt, 1))).toEqual([300, 600, 1200, 2400, 4800]);
});

test("no wait is longer than eight seconds", () => {
  expect(backOff(5, 1)).toBe(8000);
  expect(backOff(2000, 1)).toBe(8000);
});

test("chance takes away up to half, so that browsers do not come back all at once", () => {
  expect(backOff(0, 0)).toBe(150);
  expect(backOff(0, 0.5)).toBe(225);
});
