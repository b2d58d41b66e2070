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

test("a list does not know how many steps an archived run has done, and does not say none", async () => {
  const over = { status: "finished", started_at: "2026-01-01T06:00:00Z", ended_at: "2026-01-01T06:10:00Z" } as const;
  serveRuns([run(2, { ...over, steps: {}, archived: true }), run(1, { ...over, steps: {} })]);
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } });
  showAt("/sites/hall/runs", [{ path: "/sites/:slug/runs", element: <RunsPage /> }], queries);
  await expect.poll(() => document.querySelectorAll("tbody tr").length).toBe(2);
  const rows = [...document.querySelectorAll("tbody tr")];
  expect(rows.map((row) => [...row.querySelectorAll("td")].some((cell) => cell.textContent === "0"))).toEqual([
    false,
    true,
  ]);
});
