// @vitest-environment jsdom
import { act, screen } from "@testing-library/react";
import { afterEach, expect, test, vi } from "vitest";
import type { Role } from "@/api/types";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, testsPages } from "@/testing/page";
import { OperationsPage } from "./OperationsPage";

testsPages();
afterEach(() => void vi.useRealTimers());

class Line {
  close() {}
}

/** The page for somebody of the site; a server that answers nothing. */
function open(role?: Role) {
  vi.stubGlobal("WebSocket", Line);
  vi.stubGlobal("fetch", () => new Promise(() => undefined));
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  if (role) queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role, stop: { active: false } });
  showAt("/sites/hall/operations", [{ path: "/sites/:slug/operations", element: <OperationsPage /> }], queries);
  return queries;
}

const notForYou = () => screen.queryByText("This page is for operators of the site.");

test("the page is said to be for operators once it is known who looks", () => {
  open();
  expect(notForYou()).toBeNull();
});

test("the page is said to be for operators to who only looks", () => {
  open("viewer");
  expect(notForYou()).not.toBeNull();
});

test("that no answer comes is read out once, and how long it is ago is shown beside it", async () => {
  vi.useFakeTimers({ now: new Date("2026-11-30T08:00:00Z") });
  const queries = open("operator");
  const none = { runs: {}, queues: [], overdue: [], open_alerts: 0 };
  act(() => void queries.setQueryData(keys.operations("hall"), none));
  await act(() => vi.advanceTimersByTimeAsync(12_000));
  const said = screen.getByText("No answer comes. This is how things were last.");
  expect(said.getAttribute("role")).toBe("status");
  const ago = screen.getByText(/^The last answer came 12\s*s ago\.$/);
  expect(ago.closest("[role=status], [aria-live]")).toBeNull();
});
