// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, testsPages } from "@/testing/page";
import { HistoryPage } from "./HistoryPage";

testsPages();
beforeEach(() => {
  const nothing = () => undefined;
  const still = class {
    close = nothing;
    observe = nothing;
    disconnect = nothing;
  };
  vi.stubGlobal("WebSocket", still);
  vi.stubGlobal("IntersectionObserver", still);
});

const version = (number: number) => ({
  number,
  name: `Draft ${number}`,
  message: "",
  author: null,
  authors: [],
  cause: "",
  created_at: "2026-11-30T08:00:00Z",
});

/** The page of a program that can be looked at. */
function open() {
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } });
  queries.setQueryData(keys.program("p"), { id: "p", name: "Tour", site: "hall" });
  queries.setQueryData(["program-origin", "p"], { origin: null });
  const routes = [{ path: "/sites/:slug/programs/:id/history", element: <HistoryPage /> }];
  showAt("/sites/hall/programs/p/history", routes, queries);
}

/** A server that knows which runs used the versions 3 and 1; it answers that when the test says so. */
function serve() {
  const run = (number: number) => ({ id: `run-${number}`, number, status: "finished" });
  const used = [
    { version: 3, count: 400, newest: [406, 405, 404].map(run) },
    { version: 1, count: 1, newest: [run(1)] },
  ];
  let tell = (): void => undefined;
  const told = new Promise<void>((resolve) => (tell = resolve));
  const asked: string[] = [];
  vi.stubGlobal("fetch", async (address: string) => {
    if (address.includes("runs")) asked.push(address);
    if (address === "/api/programs/p/version-runs?oldest=1&newest=3") {
      await told;
      return Response.json(used);
    }
    return Response.json(address.includes("/versions?") ? [3, 2, 1].map(version) : []);
  });
  return { asked, tell: () => tell() };
}

test("which runs used a version is asked of the server, and nothing is said before it has answered", async () => {
  const { asked, tell } = serve();
  open();
  expect(await screen.findByText("Draft 2")).toBeDefined();
  expect(screen.queryByText("No run used it")).toBeNull();
  tell();
  expect(await screen.findAllByText("No run used it")).toHaveLength(1);
  expect(screen.getByText("400 runs")).toBeDefined();
  expect(screen.getAllByText(/^Run \d/).map((link) => link.textContent)).toEqual([
    "Run 406",
    "Run 405",
    "Run 404",
    "Run 1",
  ]);
  expect(asked.filter((address) => !address.includes("state=open"))).toEqual([
    "/api/programs/p/version-runs?oldest=1&newest=3",
  ]);
});

test("older versions that cannot be fetched are said, and asked for again", async () => {
  let isDown = true;
  const next = { headers: { Link: '</api/programs/p/versions?before=3>; rel="next"' } };
  vi.stubGlobal("fetch", (address: string) => {
    if (address.endsWith("/versions?before=3"))
      return Promise.resolve(
        isDown ? Response.json({ detail: "Too much." }, { status: 429 }) : Response.json([version(2)]),
      );
    return Promise.resolve(address.includes("/versions?") ? Response.json([version(3)], next) : Response.json([]));
  });
  open();
  fireEvent.click(await screen.findByText("Older versions"));
  expect(await screen.findByText("Too much.")).toBeTruthy();
  expect(screen.queryByText("Older versions")).toBeNull();
  isDown = false;
  fireEvent.click(screen.getByText("Try again"));
  expect(await screen.findByText("Draft 2")).toBeTruthy();
  expect(screen.queryByText("Too much.")).toBeNull();
});
