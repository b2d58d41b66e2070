// @vitest-environment jsdom
import { cleanup, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { RunSummary } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { FINISHED, PLANNED, run } from "@/testing/runs";
import { RecentRuns } from "./RecentRuns";

testsPages();

const showRuns = (runs: readonly RunSummary[]) => show(<RecentRuns slug="a" runs={runs} />);

test("a run that waits for its time is planned, not going on now", () => {
  showRuns([run(12, PLANNED), run(11, { status: "running" })]);
  const [planned, running] = screen.getAllByRole("listitem").map(({ textContent }) => textContent);
  expect(planned).toContain("Planned");
  expect(planned).not.toContain("now");
  expect(running).toContain("now");
});

test("the newest fifty runs are not said to be all", () => {
  showRuns(FINISHED.slice(0, 49));
  expect(screen.getByText("See all 49")).toBeTruthy();
  cleanup();
  showRuns(FINISHED.slice(0, 50));
  expect(screen.getByText("See all")).toBeTruthy();
});
