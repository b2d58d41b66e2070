// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { cleanup, render, screen } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import type { RunSummary } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { RecentRuns } from "./RecentRuns";

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

function show(runs: readonly RunSummary[]): void {
  render(
    <MantineProvider env="test">
      <MemoryRouter>
        <RecentRuns slug="a" runs={runs} />
      </MemoryRouter>
    </MantineProvider>,
  );
}

test("a run that waits for its time is planned, not going on now", () => {
  show([run(12, PLANNED), run(11, { status: "running" })]);
  const [planned, running] = screen.getAllByRole("listitem").map(({ textContent }) => textContent);
  expect(planned).toContain("Planned");
  expect(planned).not.toContain("now");
  expect(running).toContain("now");
});

test("the newest fifty runs are not said to be all", () => {
  show(FINISHED.slice(0, 49));
  expect(screen.getByText("See all 49")).toBeTruthy();
  cleanup();
  show(FINISHED.slice(0, 50));
  expect(screen.getByText("See all")).toBeTruthy();
});
