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
  await askFor("hall", "1", [KEY]);
  expect(knownRoute("hall", "1", KEY)).toBeNull();
  await vi.advanceTimersByTimeAsync(5000);
  expect(knownRoute("hall", "1", KEY)).toEqual(WAY);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(fetched).toHaveBeenCalledTimes(3);
});

test("a refusal is not asked for again by itself", async () => {
  const fetched = vi.fn(() => Promise.resolve(new Response("{}", { status: 422 })));
  vi.stubGlobal("fetch", fetched);
  await askFor("hall", "2", [KEY]);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(fetched).toHaveBeenCalledTimes(1);
});

function answer(ways: unknown): Response {
  return new Response(JSON.stringify(ways), { status: 200 });
}

test("without the server a way that was known before is drawn as it was, once the person is known", async () => {
  const kept = new Map<string, Response>([["/api/me", new Response("{}")]]);
  const cache = {
    match: (path: string) => Promise.resolve(kept.get(path)?.clone()),
    put: (path: string, response: Response) => Promise.resolve(kept.set(path, response)),
  };
  vi.stubGlobal("caches", { match: cache.match, open: () => Promise.resolve(cache) });
  vi.stubGlobal("fetch", () => Promise.resolve(answer([WAY])));
  await askFor("hall", "3", [KEY]);
  await vi.waitFor(() => expect([...kept.keys()]).toContain("/kept/routes/hall/3"), 20_000);
  vi.resetModules();
  const again = await import("./useRoutes");
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no network")));
  expect(again.knownRoute("hall", "3", KEY)).toBeNull();
  await again.askFor("hall", "3", [KEY]);
  expect(again.knownRoute("hall", "3", KEY)).toEqual(WAY);
  expect(again.knownRoute("hall", "4", KEY)).toBeNull();
});

test("after signing out no way is kept", async () => {
  const open = vi.fn();
  vi.stubGlobal("caches", { match: () => Promise.resolve(undefined), open });
  vi.stubGlobal("fetch", () => Promise.resolve(answer([WAY])));
  await askFor("hall", "5", [KEY]);
  await vi.advanceTimersByTimeAsync(100);
  expect(open).not.toHaveBeenCalled();
});
