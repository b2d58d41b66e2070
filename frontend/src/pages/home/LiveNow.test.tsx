// @vitest-environment jsdom
import { screen, act, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import { makeQueryClient } from "@/api/queries";
import { SiteFeed } from "@/live/feed";
import { show, testsPages } from "@/testing/page";
import { FINISHED, PLANNED, run, serveRuns } from "@/testing/runs";
import { LiveNow } from "./LiveNow";

testsPages();

test("a run that is under way is seen beside two that wait for their time", async () => {
  serveRuns([run(12, PLANNED), run(11, PLANNED), run(10, { status: "running" })]);
  show(<LiveNow slug="a" />);
  expect(await screen.findByText(/Program 10/)).toBeTruthy();
  expect(screen.queryByText(/Program 1[12]/)).toBeNull();
});

test("a run that goes on since before the newest fifty is seen, until it is over", async () => {
  const old = run(5, { status: "running" });
  const asked = serveRuns([...FINISHED, old]);
  const queries = makeQueryClient();
  const feed = new SiteFeed("a", queries);
  show(<LiveNow slug="a" />, queries);
  expect(await screen.findByText(/Program 5/)).toBeTruthy();
  expect(asked.filter((path) => path.includes("/sites/a/runs"))).toHaveLength(1);
  act(() => feed.take({ type: "run", run: { ...old, status: "finished" } }));
  await waitFor(() => expect(screen.queryByText(/No program is running/)).not.toBeNull());
  act(() => feed.take({ type: "run", run: run(66, { status: "running" }) }));
  expect(await screen.findByText(/Program 66/)).toBeTruthy();
  feed.end();
});
