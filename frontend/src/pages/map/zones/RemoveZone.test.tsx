// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider, type QueryClient } from "@tanstack/react-query";
import { cleanup, render, screen } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import type { ReactNode } from "react";
import { makeQueryClient } from "@/api/queries";
import type { MapZone, Program, RunSummary, SiteMap } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { isOpen } from "@/live/messages";
import { ZoneUses } from "./RemoveZone";

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
    return path.includes("/runs/") ? { ...run(1), compiled: null } : path.includes("/programs") ? [PROGRAM] : [];
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

const PROGRAM = { id: "p-5", name: "Nightly", places: ["dock"], devices: [] } as unknown as Program;
const MAP = { places: [{ id: "dock", name: "Dock", kind: "spot", x: 1, y: 1 }] } as unknown as SiteMap;
const ZONE = {
  id: "z",
  points: [
    [0, 0],
    [2, 0],
    [2, 2],
    [0, 2],
  ],
} as unknown as MapZone;

test("who removes a zone is told of a run that goes there since before the newest fifty", async () => {
  serve([...FINISHED, run(5, { status: "running" })]);
  show(makeQueryClient(), <ZoneUses slug="a" map={MAP} zone={ZONE} />);
  const link = await screen.findByRole("link", { name: /5/ });
  expect(link.getAttribute("href")).toBe("/runs/run-5");
});
