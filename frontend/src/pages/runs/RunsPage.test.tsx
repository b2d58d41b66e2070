// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, testsPages } from "@/testing/page";
import { FINISHED, run, serveRuns } from "@/testing/runs";
import { RunsPage } from "./RunsPage";

testsPages();
beforeEach(() => {
  vi.stubGlobal(
    "WebSocket",
    class {
      close() {}
    },
  );
});

test("the page of runs counts those that are under way and older than those in its list, too", async () => {
  serveRuns([...FINISHED, run(3, { status: "running" }), run(2, { status: "paused" }), run(1)]);
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } });
  showAt("/sites/hall/runs", [{ path: "/sites/:slug/runs", element: <RunsPage /> }], queries);
  expect(await screen.findByText("2 running")).toBeDefined();
});
