import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { askFor, knownRoute } from "./useRoutes";

const KEY = JSON.stringify([{ device: "shelf" }, [1, 1], { device: "oven" }, [2, 2]]);
const WAY = { path: [[1, 1]], length_m: 18.4, seconds: 66 };

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("document", { cookie: "csrftoken=token" });
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

test("a way that was asked for while the server was away is known once it is back", async () => {
  const answers = [Promise.reject(new TypeError("no network")), new Response("{}", { status: 503 }), answer([WAY])];
  const fetched = vi.fn(async () => answers.shift());
  vi.stubGlobal("fetch", fetched);
  await askFor("hall", 1, [KEY]);
  expect(knownRoute("hall", 1, KEY)).toBeNull();
  await vi.advanceTimersByTimeAsync(5000);
  expect(knownRoute("hall", 1, KEY)).toEqual(WAY);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(fetched).toHaveBeenCalledTimes(3);
});

test("a refusal is not asked for again by itself", async () => {
  const fetched = vi.fn(() => Promise.resolve(new Response("{}", { status: 422 })));
  vi.stubGlobal("fetch", fetched);
  await askFor("hall", 2, [KEY]);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(fetched).toHaveBeenCalledTimes(1);
});

function answer(ways: unknown): Response {
  return new Response(JSON.stringify(ways), { status: 200 });
}
