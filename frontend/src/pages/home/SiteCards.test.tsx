// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider, type QueryClient } from "@tanstack/react-query";
import { cleanup, render, screen } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import type { ReactNode } from "react";
import { makeQueryClient } from "@/api/queries";
import type { RunSummary, Site } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { isOpen } from "@/live/messages";
import { SiteCards } from "./SiteCards";

vi.hoisted(() => {
  Object.assign(globalThis, {
    matchMedia: () => ({ matches: false, addEventListener() {}, removeEventListener() {} }),
  });
});

/** The map asks how big it is; here it is not drawn. */
class NoSize {
  observe() {}
  disconnect() {}
}

beforeAll(async () => {
  Object.assign(globalThis, { ResizeObserver: NoSize });
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

const SITE = {
  slug: "a",
  name: "Hall",
  role: "viewer",
  has_map: true,
  stop: { active: false },
  machines: 0,
  robots: 0,
  pending: 0,
} as unknown as Site;

test("a site where a run goes on since before the newest fifty is said to run", async () => {
  serve([...FINISHED, run(5, { status: "running" })]);
  const queries = makeQueryClient();
  queries.setQueryData(["map", "a"], null);
  show(queries, <SiteCards sites={[SITE]} />);
  expect(await screen.findByText("Running")).toBeTruthy();
});

test("a site where a run waits for its time is idle", async () => {
  const asked = serve([run(12, PLANNED)]);
  const queries = makeQueryClient();
  queries.setQueryData(["map", "a"], null);
  show(queries, <SiteCards sites={[SITE]} />);
  await vi.waitFor(() => expect(queries.isFetching()).toBe(0));
  expect(asked.filter((path) => path.includes("/runs"))).toHaveLength(1);
  expect(screen.queryByText("Running")).toBeNull();
  expect(screen.getByText("Idle")).toBeTruthy();
});
