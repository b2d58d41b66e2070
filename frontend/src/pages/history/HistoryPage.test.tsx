// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, render, screen } from "@testing-library/react";
import { createMemoryRouter, RouterProvider } from "react-router-dom";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { loadScreenTexts, startI18n } from "@/i18n";
import { forgetLive } from "@/live/site";

beforeEach(async () => {
  const nothing = () => undefined;
  const still = class {
    close = nothing;
    observe = nothing;
    disconnect = nothing;
  };
  vi.stubGlobal("WebSocket", still);
  vi.stubGlobal("IntersectionObserver", still);
  vi.stubGlobal("matchMedia", () => ({ matches: false, addEventListener: nothing, removeEventListener: nothing }));
  await startI18n();
  await loadScreenTexts();
});
afterEach(() => {
  cleanup();
  forgetLive(false);
  vi.unstubAllGlobals();
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
  const { HistoryPage } = await import("./HistoryPage"); // the theme asks for the window's when it is loaded
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } });
  queries.setQueryData(keys.program("p"), { id: "p", name: "Tour", site: "hall" });
  queries.setQueryData(["program-origin", "p"], { origin: null });
  const routes = [{ path: "/sites/:slug/programs/:id/history", element: <HistoryPage /> }];
  render(
    <QueryClientProvider client={queries}>
      <MantineProvider env="test">
        <RouterProvider router={createMemoryRouter(routes, { initialEntries: ["/sites/hall/programs/p/history"] })} />
      </MantineProvider>
    </QueryClientProvider>,
  );
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
