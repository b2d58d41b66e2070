// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import { SiteFeed } from "@/live/feed";
import { useShownRuns } from "./useShownRuns";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

const PART = 50;
const run = (number: number) => ({ id: `run-${number}`, number, status: "finished", program: { id: "p" } });

const down = (from: number, to: number) => Array.from({ length: from - to + 1 }, (_, at) => from - at);

/** A site with the runs from 1 to `site.runs`, which the server gives in parts. */
function serve(runs: number) {
  const site = { runs, asked: 0 };
  vi.stubGlobal("fetch", (address: string) => {
    const { pathname, searchParams } = new URL(address, "http://vipo");
    if (pathname !== "/api/sites/hall/runs") return Promise.resolve(new Response("{}", { status: 404 }));
    site.asked += 1;
    const newest = Number(searchParams.get("before") ?? site.runs + 1) - 1;
    const oldest = Math.max(1, newest - PART + 1);
    const next = `</api/sites/hall/runs?limit=${PART}&before=${oldest}>; rel="next"`;
    const headers = oldest > 1 ? { Link: next } : undefined;
    return Promise.resolve(new Response(JSON.stringify(down(newest, oldest).map(run)), { headers }));
  });
  return site;
}

function open() {
  const queries = makeQueryClient();
  const around = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  const { result } = renderHook(() => useShownRuns("hall"), { wrapper: around });
  const shows = (numbers: number[], hasOlder: boolean) =>
    waitFor(() => {
      expect(result.current.shown.map((each) => each.number)).toEqual(numbers);
      expect(result.current.parts.hasNextPage).toBe(hasOlder);
    });
  return {
    feed: new SiteFeed("hall", queries),
    shows,
    showOlder: () => act(() => result.current.parts.fetchNextPage()),
  };
}

test("no run is missing after more than a part of them while nobody heard of it", async () => {
  const site = serve(120);
  const { feed, shows, showOlder } = open();
  await shows(down(120, 71), true);
  await showOlder();
  await shows(down(120, 21), true);
  site.runs = 230;
  act(() => feed.take({ type: "hello", site: "hall" }));
  await shows(down(230, 131), true); // as many parts as were asked for
  await showOlder();
  await showOlder();
  await shows(down(230, 31), true);
});

test("a list that nobody went down in stays one part, however many runs begin while it is open", async () => {
  const site = serve(120);
  const { feed, shows } = open();
  await shows(down(120, 71), true);
  expect(site.asked).toBe(1);
  for (const runs of [420, 1020]) {
    [site.runs, site.asked] = [runs, 0];
    act(() => feed.take({ type: "hello", site: "hall" }));
    await shows(down(runs, runs - 49), true);
    await new Promise((done) => setTimeout(done, 50));
    expect(site.asked).toBe(1); // the newest, which are the first part
  }
});

test("news of an old run leave no gap before it", async () => {
  serve(120);
  const { feed, shows, showOlder } = open();
  await shows(down(120, 71), true);
  act(() => feed.take({ type: "run", run: run(5) } as never));
  await showOlder();
  await shows(down(120, 21), true);
  await showOlder();
  await shows(down(120, 1), false);
});
