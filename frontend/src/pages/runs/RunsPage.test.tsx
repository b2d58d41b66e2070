// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, render, screen } from "@testing-library/react";
import { createMemoryRouter, RouterProvider } from "react-router-dom";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { RunSummary } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { isOpen } from "@/live/messages";
import { forgetLive } from "@/live/site";

beforeEach(async () => {
  vi.stubGlobal(
    "WebSocket",
    class {
      close() {}
    },
  );
  vi.stubGlobal("matchMedia", () => ({ matches: false, addEventListener() {}, removeEventListener() {} }));
  await startI18n();
  await loadScreenTexts();
});
afterEach(() => {
  cleanup();
  forgetLive(false);
  vi.unstubAllGlobals();
});

const run = (number: number, status = "finished") =>
  ({
    id: `run-${number}`,
    number,
    program: { id: "p", name: "Tour" },
    status,
    started_at: "2026-11-30T08:00:00Z",
    steps: {},
  }) as RunSummary;

/** A site's runs as its server gives them: the newest 50, or all that are not over. */
function serve(runs: readonly RunSummary[]): void {
  const answer = (path: string) => {
    if (path.includes("/runs?state=open")) return runs.filter(isOpen);
    return path.includes("/runs") ? runs.slice(0, 50) : [];
  };
  vi.stubGlobal("fetch", (path: string) => Promise.resolve(Response.json(answer(path))));
}

test("the page of runs counts those that are under way and older than those in its list, too", async () => {
  serve([...Array.from({ length: 60 }, (_, at) => run(63 - at)), run(3, "running"), run(2, "paused"), run(1)]);
  const { RunsPage } = await import("./RunsPage"); // the theme asks for the window's when it is loaded
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } });
  const routes = [{ path: "/sites/:slug/runs", element: <RunsPage /> }];
  render(
    <QueryClientProvider client={queries}>
      <MantineProvider env="test">
        <RouterProvider router={createMemoryRouter(routes, { initialEntries: ["/sites/hall/runs"] })} />
      </MantineProvider>
    </QueryClientProvider>,
  );
  expect(await screen.findByText("2 running")).toBeDefined();
});
