// @vitest-environment jsdom
import { cleanup } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import type { Program, RunSummary } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { FINISHED, PLANNED, run } from "@/testing/runs";
import { ProgramTable } from "./ProgramTable";

testsPages();

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
  show(<ProgramTable programs={[PROGRAM]} runs={runs} open={open} editable={false} />);
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
