// @vitest-environment jsdom
import { act, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, testsPages } from "@/testing/page";
import { PageShell } from "./PageShell";
import { SETTINGS } from "./settings";

/** A line to a server that the test plays. */
class Line {
  static all: Line[] = [];
  onmessage: ((event: { data: string }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;
  constructor() {
    Line.all.push(this);
  }
  close() {}
}

testsPages();
beforeEach(() => {
  Line.all = [];
  vi.stubGlobal("WebSocket", Line);
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json([])));
});
afterEach(() => {
  vi.useRealTimers();
});

const siteOf = (slug: string) => ({ slug, name: "Hall", role: "admin", stop: { active: false } });

/** A page of a site with all that its bars ask for, while its line is live. */
function openPage(slug: string) {
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site(slug), siteOf(slug));
  const element = <PageShell title="People">Carla</PageShell>;
  showAt(`/sites/${slug}`, [{ path: "/sites/:slug", element }], queries);
  act(() => Line.all[0]?.onmessage?.({ data: JSON.stringify({ type: "hello", site: slug }) }));
  expect(screen.getByRole("main").textContent).toBe("Carla");
}

test("the page of a site closes when its member is removed, and says why", () => {
  openPage("hall");
  act(() => Line.all[0]?.onclose?.({ code: 4403 }));
  expect(screen.getByRole("main").textContent).toContain("Your access to this site has ended");
  expect(screen.getByRole("main").textContent).not.toContain("Carla");
});

test.each([
  [{ handle: SETTINGS }, true],
  [{}, false],
])("a page of the settings marks them in the side bar, and no other page does", (more, isMarked) => {
  const element = <PageShell title="Review">rule</PageShell>;
  showAt("/sites/hall/review", [{ path: "/sites/:slug/review", element, ...more }]);
  expect(screen.getByText("Settings").closest("a")?.classList.contains("active")).toBe(isMarked);
  expect(document.title).toBe("Review · VIPO");
});

test("after that the page asks nothing more about the site", async () => {
  vi.useFakeTimers({ toFake: ["setInterval", "setTimeout", "clearInterval", "clearTimeout", "Date"] });
  const asked: string[] = [];
  vi.stubGlobal("fetch", (path: string) => {
    asked.push(path);
    return Promise.resolve(Response.json(path === "/api/sites/barn" ? siteOf("barn") : []));
  });
  openPage("barn");
  await act(() => vi.advanceTimersByTimeAsync(12_000));
  expect(asked.filter((path) => path === "/api/sites/barn/findings")).toHaveLength(3);
  asked.length = 0;
  act(() => Line.all[0]?.onclose?.({ code: 4403 }));
  await act(() => vi.advanceTimersByTimeAsync(60_000));
  expect(asked).toEqual(["/api/sites"]);
});

test("a page of which too many are open stays, and says that it is told nothing new", () => {
  openPage("shed");
  act(() => Line.all[0]?.onclose?.({ code: 4429 }));
  expect(screen.getByRole("main").textContent).toBe("Carla");
  expect(screen.getByText(/^So many pages of this site are open/)).toBeDefined();
});
