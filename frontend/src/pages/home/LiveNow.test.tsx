// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider, type QueryClient } from "@tanstack/react-query";
import { cleanup, render, screen, act, waitFor } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import type { ReactNode } from "react";
import { makeQueryClient } from "@/api/queries";
import type { RunSummary } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { SiteFeed } from "@/live/feed";
import { isOpen } from "@/live/messages";
import { LiveNow } from "./LiveNow";

vi.hoisted(() => {
  Object.assign(globalThis, {
    matchMedia: () => ({ matches: false, addEventListener() {}, removeEventListener() {} }),
  });
});

beforeAll(async () => {
  await startI18n();
  await loadScreenTexts();
});
afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

const LATER = new Date(Date.now() + 7 * 86_400_000).toISOString();
const PLANNED = { status: "pending", started_at: null, not_before: LATER } as const;
const run = (number: number, more: Partial<RunSummary> = {}) =>
  ({
    id: `run-${number}`,
    number,
    program: { id: `p-${number}`, name: `Program ${number}` },
    status: "finished",
    started_at: "2026-11-30T08:00:00Z",
    ended_at: null,
    not_before: null,
    deadline: null,
    steps: {},
    reason: "",
    cause: null,
    started_by: null,
    ...more,
  }) as RunSummary;
const FINISHED = Array.from({ length: 60 }, (_, index) => run(65 - index));

/** A site's runs as its server gives them: the newest 50, or all that are not over. */
function serve(runs: readonly RunSummary[]): string[] {
  const asked: string[] = [];
  const answer = (path: string) => {
    if (path.includes("/runs?state=open")) return runs.filter(isOpen);
    if (path.endsWith("/runs")) return runs.slice(0, 50);
    return path.includes("/runs/") ? { ...run(1), compiled: null } : [];
  };
  vi.stubGlobal("fetch", (path: string) => {
    asked.push(path);
    return Promise.resolve(new Response(JSON.stringify(answer(path)), { status: 200 }));
  });
  return asked;
}

function show(queries: QueryClient, what: ReactNode): void {
  render(
    <QueryClientProvider client={queries}>
      <MantineProvider env="test">
        <MemoryRouter>{what}</MemoryRouter>
      </MantineProvider>
    </QueryClientProvider>,
  );
}

test("a run that is under way is seen beside two that wait for their time", async () => {
  serve([run(12, PLANNED), run(11, PLANNED), run(10, { status: "running" })]);
  show(makeQueryClient(), <LiveNow slug="a" />);
  expect(await screen.findByText(/Program 10/)).toBeTruthy();
  expect(screen.queryByText(/Program 1[12]/)).toBeNull();
});

test("a run that goes on since before the newest fifty is seen, until it is over", async () => {
  const old = run(5, { status: "running" });
  const asked = serve([...FINISHED, old]);
  const queries = makeQueryClient();
  const feed = new SiteFeed("a", queries);
  show(queries, <LiveNow slug="a" />);
  expect(await screen.findByText(/Program 5/)).toBeTruthy();
  expect(asked.filter((path) => path.includes("/sites/a/runs"))).toHaveLength(1);
  act(() => feed.take({ type: "run", run: { ...old, status: "finished" } }));
  await waitFor(() => expect(screen.queryByText(/No program is running/)).not.toBeNull());
  act(() => feed.take({ type: "run", run: run(66, { status: "running" }) }));
  expect(await screen.findByText(/Program 66/)).toBeTruthy();
  feed.end();
});
