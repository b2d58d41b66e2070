import { expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { Device, RunSummary, VersionRuns } from "@/api/types";
import { SiteFeed } from "./feed";

test("the newest runs of a version are asked for again when they tell another state of one", () => {
  const queries = makeQueryClient();
  const feed = new SiteFeed("hall", queries);
  const key = [...keys.versionRuns("hall", "task"), 1, 9];
  const tell = (status: RunSummary["status"]) => {
    const run = { id: "r", status, program: { id: "task" } } as RunSummary;
    queries.setQueryData(key, [{ version: 2, count: 1, newest: [{ id: "r", status: "running" }] }] as VersionRuns[]);
    feed.take({ type: "run", run });
    return queries.getQueryState(key)?.isInvalidated;
  };
  expect([tell("running"), tell("paused"), tell("running"), tell("finished")]).toEqual([false, true, false, true]);
  feed.end();
  queries.clear();
});

test("what happens to a device is asked for again when its state changes, and not with each reading", () => {
  vi.useFakeTimers();
  const queries = makeQueryClient();
  const feed = new SiteFeed("hall", queries);
  const [mixer, oven] = ["mixer", "oven"].map((id) => [...keys.deviceEvents("hall", id), 6] as const);
  queries.setQueryData(keys.devices("hall"), [{ id: "mixer" }, { id: "oven" }]);
  const tell = (more: Partial<Device>) => {
    for (const key of [mixer, oven]) queries.setQueryData(key ?? [], []);
    feed.take({ type: "device", device: { id: "mixer", ...more } });
    vi.advanceTimersByTime(2000);
    return [mixer, oven].map((key) => queries.getQueryState(key ?? [])?.isInvalidated);
  };
  const location = { x: 1, y: 0, z: 0, theta: 0 };
  expect([tell({ properties: [], location, done: false }), tell({ doing: "mixes" })]).toEqual([
    [false, false],
    [false, false],
  ]);
  expect([tell({ status: "offline" }), tell({ lifecycle: "retired" }), tell({ name: "Old mixer" })]).toEqual([
    [true, false],
    [true, false],
    [true, false],
  ]);
  feed.end();
  queries.clear();
  vi.useRealTimers();
});
