import { afterEach, expect, test, vi } from "vitest";
import { api, ApiProblem, untilRefused } from "./client";

afterEach(() => vi.unstubAllGlobals());

test("what is asked for over and over is asked until this person may not know it, or it is gone", () => {
  const after = (error: Error | null) => untilRefused(5000)({ state: { error } });
  expect([403, 404].map((status) => after(new ApiProblem(status, "not_found", "")))).toEqual([false, false]);
  expect([429, 500, 503].map((status) => after(new ApiProblem(status, "", "")))).toEqual([5000, 5000, 5000]);
  expect([after(null), after(new TypeError("no network"))]).toEqual([5000, 5000]);
});

test.each([
  ["no words of ours", "<h1>404</h1>"],
  ["other words", '{"detail": "no route"}'],
  ["a number", '{"code": 404, "message": "no route"}'],
])("it is asked on where a proxy says that nothing is there, with %s", async (_, said) => {
  vi.stubGlobal("fetch", () => Promise.resolve(new Response(said, { status: 404 })));
  const error = await api.get("/sites/hall/findings").then(
    () => null,
    (problem: Error) => problem,
  );
  expect(error).toMatchObject({ status: 404, code: "unexpected" });
  expect(untilRefused(5000)({ state: { error } })).toBe(5000);
});
