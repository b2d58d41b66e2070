import { expect, test } from "vitest";
import { ApiProblem, untilRefused } from "./client";

test("what is asked for over and over is asked until this person may not know it, or it is gone", () => {
  const after = (error: Error | null) => untilRefused(5000)({ state: { error } });
  expect([403, 404].map((status) => after(new ApiProblem(status, "", "")))).toEqual([false, false]);
  expect([429, 500, 503].map((status) => after(new ApiProblem(status, "", "")))).toEqual([5000, 5000, 5000]);
  expect([after(null), after(new TypeError("no network"))]).toEqual([5000, 5000]);
});
