import { expect, test } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { RunSummary, VersionRuns } from "@/api/types";
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
