// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider, type QueryClient } from "@tanstack/react-query";
import { cleanup, render } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import type { ReactNode } from "react";
import { makeQueryClient } from "@/api/queries";
import type { Program, RunSummary } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { ProgramTable } from "./ProgramTable";

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

function show(queries: QueryClient, what: ReactNode): void {
  render(
    <QueryClientProvider client={queries}>
      <MantineProvider env="test">
        <MemoryRouter>{what}</MemoryRouter>
      </MantineProvider>
    </QueryClientProvider>,
  );
}

const PROGRAM = {
  id: "p-5",
  site: "a",
  name: "Nightly",
  kinds: ["move"],
  edited_by: null,
  edited_at: "2026-11-01T00:00:00Z",
  errors: 0,
  warnings: 0,
} as unknown as Program;

/** What the row of the program says of its last run. */
function lastRun(runs: RunSummary[] | undefined, open: RunSummary[] | undefined): string | null | undefined {
  vi.stubGlobal("fetch", () => Promise.resolve(new Response("[]", { status: 200 })));
  show(makeQueryClient(), <ProgramTable programs={[PROGRAM]} runs={runs} open={open} editable={false} />);
  const said = document.querySelector("td:last-child")?.textContent;
  cleanup();
  return said;
}

test("a program never ran only if all runs are known", () => {
  expect(lastRun([], [])).toBe("Never");
  expect(lastRun(FINISHED.slice(0, 49), [])).toBe("Never");
  expect(lastRun(FINISHED.slice(0, 50), [])).toBe("Not lately");
  expect(lastRun(undefined, [])).toBe("");
  expect(lastRun(FINISHED.slice(0, 49), undefined)).toBe("");
});

test("a program whose run goes on since before the newest fifty is running", () => {
  expect(lastRun(FINISHED.slice(0, 50), [run(5, { status: "running" })])).toBe("Run 5 running");
});

test("a program whose run waits for its time is not running", () => {
  const planned = run(12, { ...PLANNED, program: { id: "p-5", name: "Nightly" } });
  expect(lastRun([planned], [planned])).toBe("Never");
  const ended_at = new Date(Date.now() - 5 * 60_000).toISOString();
  expect(lastRun([planned, run(5, { ended_at })], [planned])).toBe("5 minutes ago");
});
