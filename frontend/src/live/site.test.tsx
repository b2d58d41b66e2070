// @vitest-environment jsdom
import { QueryClient, QueryClientProvider, useQueries, useQuery, type QueryKey } from "@tanstack/react-query";
import { act, cleanup, render } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys } from "@/api/queries";
import { liveRobots } from "./robots";
import { useSiteLive } from "./site";
import { EMPTY, useLiveStore } from "./store";

/** A line to a server that the test plays. */
class Line {
  static all: Line[] = [];
  onmessage: ((event: { data: string }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;
  constructor(readonly url: string) {
    Line.all.push(this);
  }
  say(message: unknown) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
  close() {}
}

const location = { x: 1, y: 0, theta: 0 };
const robot = (id: string) => ({ id, name: id, kind: "robot", status: "idle", carrying: {}, properties: [], location });
const lineOf = (slug: string) => Line.all.filter(({ url }) => url.endsWith(`/${slug}`)).at(-1) as Line;
const pass = (ms: number) => act(() => vi.advanceTimersByTimeAsync(ms));
const seen = () => liveRobots(performance.now()).map(({ name }) => name);

let queries: QueryClient;

function Site({ slug }: { slug: string }) {
  useSiteLive(slug);
  useQuery({ queryKey: keys.devices(slug), queryFn: () => [robot(`robot of ${slug}`)] });
  return null;
}

const page = (...slugs: string[]) => (
  <QueryClientProvider client={queries}>
    {slugs.map((slug) => (
      <Site key={slug} slug={slug} />
    ))}
  </QueryClientProvider>
);

async function show(...slugs: string[]) {
  const { rerender } = render(page(...slugs));
  await pass(10);
  for (const slug of slugs) lineOf(slug).say({ type: "hello", site: slug });
  await pass(1500);
  return async (...others: string[]) => {
    rerender(page(...others));
    await pass(10);
  };
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", Line);
  queries = new QueryClient({ defaultOptions: { queries: { staleTime: 30_000 } } });
  useLiveStore.setState(EMPTY);
  Line.all = [];
});
afterEach(async () => {
  cleanup();
  await vi.advanceTimersByTimeAsync(5000);
  vi.useRealTimers();
});

test("the map shows the robots of the site that is looked at, whatever the line of another says", async () => {
  await show("a", "b");
  expect(seen()).toEqual(["robot of b"]);
  lineOf("a").say({ type: "device", device: { id: "robot of a", location: { x: 3, y: 3, theta: 0 } } });
  lineOf("a").say({ type: "stop", active: true, by: "Anna", at: null });
  lineOf("a").say({ type: "traffic", robots: { "robot of a": { route: [], reserved: [], wait: null } } });
  await pass(60_000);
  expect(seen()).toEqual(["robot of b"]);
  expect(useLiveStore.getState()).toMatchObject({ site: "b", stop: null, traffic: {} });
});

test("whoever comes back to a site whose line is still there sees its robots, and that the line is lost", async () => {
  const change = await show("a");
  await change("a", "b");
  await change("b");
  await change("b", "a");
  await pass(1500);
  expect(seen()).toEqual(["robot of a"]);
  lineOf("a").onclose?.({ code: 1006 });
  expect(useLiveStore.getState()).toMatchObject({ site: "a", connection: "reconnecting" });
});

test("another name of a program reaches who has it open", async () => {
  await show("a");
  queries.setQueryData(keys.program("p"), { name: "Team" });
  lineOf("a").say({ type: "programs" });
  expect(queries.getQueryState(keys.program("p"))?.isInvalidated).toBe(true);
  queries.setQueryData(keys.program("p"), { name: "Crew" });
  await pass(10);
  lineOf("a").say({ type: "hello", site: "a" }); // it was away, and does not know what happened
  expect(queries.getQueryState(keys.program("p"))?.isInvalidated).toBe(true);
});

test("from a site to another and back within two seconds", async () => {
  const change = await show("a");
  await change("b");
  await change("a");
  await pass(60_000);
  expect(seen()).toEqual(["robot of a"]);
  lineOf("a").onclose?.({ code: 1006 });
  expect(useLiveStore.getState()).toMatchObject({ site: "a", connection: "reconnecting" });
});

test("a site that is looked at again after its line has ended is not live before the new one is", async () => {
  const change = await show("a");
  await change();
  await pass(5000);
  await change("a");
  expect(useLiveStore.getState().connection).toBe("connecting");
});

/** What is on the screen, each fetched as often as `asked` names it. */
function Screen({ asked }: { asked: string[] }) {
  useSiteLive("a");
  useQueries({
    queries: OF_NEWS.map((queryKey) => ({ queryKey, queryFn: () => (asked.push(String(queryKey[0])), []) })),
  });
  return null;
}
const OF_NEWS: readonly QueryKey[] = [
  ["review", "asked", "a"],
  ["review", "program", "draft"],
  keys.setting("a", "review-rule"),
  keys.rehearsals("a"),
  keys.overAlerts("a"),
  keys.comparison("program"),
  keys.measurements("run"),
  keys.paces("a", "mixer"),
  keys.deviceEvents("a", "mixer"),
  keys.sites,
];

test("all that news are about is fetched anew after a line that was lost, and once only when a page opens", async () => {
  const asked: string[] = [];
  render(
    <QueryClientProvider client={queries}>
      <Screen asked={asked} />
    </QueryClientProvider>,
  );
  await pass(10);
  lineOf("a").say({ type: "hello", site: "a" });
  await pass(1000);
  const names = OF_NEWS.map(([name]) => String(name));
  expect(asked).toEqual(names);
  lineOf("a").onclose?.({ code: 1006 });
  await pass(1000);
  lineOf("a").say({ type: "hello", site: "a" });
  await pass(1000);
  expect(asked.slice(names.length).toSorted()).toEqual(names.toSorted());
});

test.each([
  [20_000, "after the greeting"],
  [40_000, "with the page"],
])("all that news are about is fetched once by who comes back to a site after %d ms, %s", async (away) => {
  const asked: string[] = [];
  const here = () =>
    render(
      <QueryClientProvider client={queries}>
        <Screen asked={asked} />
      </QueryClientProvider>,
    );
  const first = here();
  await pass(10);
  lineOf("a").say({ type: "hello", site: "a" });
  first.unmount();
  await pass(away);
  asked.length = 0;
  here();
  lineOf("a").say({ type: "hello", site: "a" });
  await pass(1000);
  expect(Line.all).toHaveLength(2);
  expect(asked.toSorted()).toEqual(OF_NEWS.map(([name]) => String(name)).toSorted());
});

test("copies that went while the line was lost are on the map no more", async () => {
  await show("a");
  lineOf("a").say({ type: "copies", copies: [{ device: "robot of a", x: 1, y: 1, theta: 0 }] });
  expect(Object.keys(useLiveStore.getState().copies)).toEqual(["robot of a"]);
  lineOf("a").onclose?.({ code: 1006 });
  await pass(1000);
  lineOf("a").say({ type: "hello", site: "a" });
  expect(useLiveStore.getState().copies).toEqual({});
});

test.each([4403, 4404])("who is no member any more (%s) is told so, and nothing of the site is kept", async (code) => {
  const people = ["people", "a", "members"];
  await show("a");
  queries.setQueryData(keys.site("a"), { slug: "a", stop: null });
  queries.setQueryData(people, ["Carla"]);
  queries.setQueryData(["people", "b", "members"], ["Bert"]);
  lineOf("a").onclose?.({ code });
  await pass(60_000);
  expect([useLiveStore.getState().connection, Line.all.length]).toEqual(["refused", 1]);
  expect([queries.getQueryData(people), queries.getQueryData(["people", "b", "members"])]).toEqual([
    undefined,
    ["Bert"],
  ]);
});

test.each(["me", "sites", "library"])("a site called %s takes no cache along that has its name", async (slug) => {
  await show(slug);
  for (const key of [keys.site(slug), keys.programs(slug), [slug], [slug, "carry", "", false]])
    queries.setQueryData(key, []);
  lineOf(slug).onclose?.({ code: 4403 });
  expect([[slug], [slug, "carry", "", false], keys.programs(slug)].map((key) => queries.getQueryData(key))).toEqual([
    [],
    [],
    undefined,
  ]);
});

test("who is a member again is let in by the next page of the site", async () => {
  const change = await show("a");
  queries.setQueryData(keys.site("a"), { slug: "a", stop: null });
  lineOf("a").onclose?.({ code: 4403 });
  await change("a", "b");
  await change("b");
  await change("b", "a");
  expect(useLiveStore.getState()).toMatchObject({ site: "a", connection: "connecting" });
  lineOf("a").say({ type: "hello", site: "a" });
  expect(useLiveStore.getState()).toMatchObject({ site: "a", connection: "live" });
});

test("a page of which too many are open is not said to be live", async () => {
  await show("a");
  lineOf("a").onclose?.({ code: 4429 });
  expect(useLiveStore.getState().connection).toBe("crowded");
  await pass(30_000);
  lineOf("a").say({ type: "hello", site: "a" });
  expect([useLiveStore.getState().connection, Line.all.length]).toEqual(["live", 2]);
});
