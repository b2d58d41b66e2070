// @vitest-environment jsdom
import { act, screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, testsPages } from "@/testing/page";
import { CompareScreen } from "./CompareScreen";

testsPages();

const REVIEW = { needed: 0, number: null, history: [], why_not: "", may_run: true, compare_with: null };
const ADDED = { root: "steps", id: "s", kind: "added", changes: [], moved: false };

/** A version beside what is drawn now, which has one step more. */
function compared(version: number) {
  const side = (number: number | null) => ({ version: number, document: { steps: {} }, compiled: null, problem: "" });
  return { old: side(version), new: side(null), difference: { constructs: [ADDED], tidied: [], same: 0 } };
}

/** The comparison with version 1, and a server that gives that with version 2 when it is told to. */
function open() {
  let answer: (() => void) | undefined;
  vi.stubGlobal(
    "WebSocket",
    class {
      close() {}
    },
  );
  vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);
  vi.stubGlobal("fetch", (path: string) => {
    if (path.includes("/comparison?old=1")) return Promise.resolve(Response.json(compared(1)));
    if (path.endsWith("/origin")) return Promise.resolve(Response.json({ origin: null, copies: [] }));
    if (/\/review(\?|$)/.test(path)) return Promise.resolve(Response.json(REVIEW));
    if (!path.includes("/comparison?old=2")) return Promise.resolve(Response.json([]));
    return new Promise((done) => (answer = () => done(Response.json(compared(2)))));
  });
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.program("p"), { id: "p", name: "Tour", site: "hall" });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role: "author", stop: { active: false } });
  const items = [2, 1].map((number) => ({
    number,
    name: "",
    cause: "",
    author: null,
    created_at: "2026-11-30T08:00:00Z",
  }));
  queries.setQueryData(keys.versions("p"), { pages: [{ items }], pageParams: [""] });
  const routes = [{ path: "/programs/:id/compare", element: <CompareScreen /> }];
  const { go } = showAt("/programs/p/compare?old=1&new=draft", routes, queries);
  return { choose: (old: number) => go(`/programs/p/compare?old=${old}&new=draft`), answer: () => answer?.() };
}

const restores = () => screen.queryAllByRole("button", { name: /restore/i }).map(({ textContent }) => textContent);

test("nothing is restored out of a version while the list still shows what another one has", async () => {
  const { choose, answer } = open();
  expect(await screen.findByText("Restore all of v1", {}, { timeout: 8000 })).toBeTruthy();
  await act(() => choose(2));
  expect(restores()).toEqual([]);
  await act(() => Promise.resolve(answer()));
  expect(await screen.findByText("Restore all of v2")).toBeTruthy();
});
