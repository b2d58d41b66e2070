// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import type { Site } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { FINISHED, PLANNED, run, serveRuns } from "@/testing/runs";
import { SiteCards } from "./SiteCards";

testsPages();

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
  serveRuns([...FINISHED, run(5, { status: "running" })]);
  const queries = makeQueryClient();
  queries.setQueryData(["map", "a"], null);
  show(<SiteCards sites={[SITE]} />, queries);
  expect(await screen.findByText("Running")).toBeTruthy();
});

test("a site where a run waits for its time is idle", async () => {
  const asked = serveRuns([run(12, PLANNED)]);
  const queries = makeQueryClient();
  queries.setQueryData(["map", "a"], null);
  show(<SiteCards sites={[SITE]} />, queries);
  await vi.waitFor(() => expect(queries.isFetching()).toBe(0), 20_000);
  expect(asked.filter((path) => path.includes("/runs"))).toHaveLength(1);
  expect(screen.queryByText("Running")).toBeNull();
  expect(screen.getByText("Idle")).toBeTruthy();
});
