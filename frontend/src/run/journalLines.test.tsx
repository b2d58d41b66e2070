// @vitest-environment jsdom
/** How a run's page comes to its journal and its timeline: little of a long one at once, and the news of both. */
import { QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import { useRunTimeline } from "@/api/runs";
import { startI18n } from "@/i18n";
import { SiteFeed } from "@/live/feed";
import { useJournalLines } from "./journalLines";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

const line = (seq: number) => ({ seq, t_s: seq, kind: "notice", text: `line ${seq}`, args: {} });

/** A server with a run whose journal has so many lines; what it is asked for is counted. */
function serve(lines: number) {
  const run = { lines, journal: 0, timeline: 0 };
  vi.stubGlobal("fetch", (address: string) => {
    const { pathname, searchParams } = new URL(address, "http://vipo");
    if (pathname === "/api/runs/r/timeline") {
      run.timeline += 1;
      return Promise.resolve(Response.json({ seq: run.lines, bars: [], steps: [], drives: {}, simulated: [] }));
    }
    run.journal += 1;
    const newest = Number(searchParams.get("before") ?? run.lines + 1) - 1;
    const oldest = Math.max(1, newest - Number(searchParams.get("limit")) + 1);
    const headers = { Link: `</api${pathname.slice(4)}?newest=true&limit=500&before=${oldest}>; rel="next"` };
    const items = Array.from({ length: newest - oldest + 1 }, (_, at) => line(oldest + at));
    return Promise.resolve(Response.json(items, oldest > 1 ? { headers } : undefined));
  });
  return run;
}

const useBoth = () => ({ journal: useJournalLines("r"), timeline: useRunTimeline("r").data });

async function open() {
  await startI18n();
  const queries = makeQueryClient();
  const around = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  const { result } = renderHook(useBoth, { wrapper: around });
  const shows = (first: number, last: number) =>
    waitFor(() => {
      const { lines, older, isFetching } = result.current.journal;
      const numbers = lines.map((each) => each.seq);
      expect([numbers[0], numbers.at(-1), numbers.length, older]).toEqual([first, last, last - first + 1, first - 1]);
      expect(isFetching).toBe(false);
    });
  const feed = new SiteFeed("hall", queries);
  const write = (seq: number) => feed.take({ type: "run_event", run: "r", event: line(seq) } as never);
  return { result, shows, feed, write };
}

test("of a journal of 20,000 lines the page asks for the newest 500 and one timeline, and for older lines when asked", async () => {
  const run = serve(20_000);
  const { result, shows, feed, write } = await open();
  await shows(19_501, 20_000);
  await waitFor(() => expect(result.current.timeline?.told.seq).toBe(20_000));
  expect(run).toMatchObject({ journal: 1, timeline: 1 });
  act(() => result.current.journal.fetchOlder());
  await shows(19_001, 20_000);
  act(() => write(20_001));
  await shows(19_001, 20_001);
  expect(result.current.timeline?.since.map(({ seq }) => seq)).toEqual([20_001]);
  expect(run).toMatchObject({ journal: 2, timeline: 1 });
  run.lines = 20_700;
  act(() => feed.take({ type: "hello", site: "hall" }));
  await shows(19_701, 20_700); // as many parts, and none of what was missed is missing
  await waitFor(() => expect(result.current.timeline).toMatchObject({ told: { seq: 20_700 }, since: [] }));
});

test("older lines that are asked for while what was missed is fetched leave no hole", async () => {
  const run = serve(2000);
  const { result, shows, feed } = await open();
  await shows(1501, 2000);
  run.lines = 2050;
  act(() => feed.take({ type: "hello", site: "hall" }));
  act(() => result.current.journal.fetchOlder());
  await shows(1551, 2050);
});

test("a journal that fits is here as a whole", async () => {
  serve(3);
  const { shows } = await open();
  await shows(1, 3);
});

test("a timeline that has grown long is fetched anew, and goes on from there", async () => {
  const run = serve(10);
  const { result, shows, write } = await open();
  await shows(1, 10);
  act(() => {
    for (let seq = 11; seq <= 1010; seq += 1) write(seq);
    run.lines = 1010;
  });
  await waitFor(() => expect(result.current.timeline).toMatchObject({ told: { seq: 1010 }, since: [] }));
  act(() => write(1011));
  await waitFor(() => expect(result.current.timeline?.since).toHaveLength(1));
  expect(run).toMatchObject({ journal: 1, timeline: 2 });
});
