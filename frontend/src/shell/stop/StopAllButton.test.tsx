// @vitest-environment jsdom
import { act, fireEvent, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { EMPTY, useLiveStore } from "@/live/store";
import { show, testsPages } from "@/testing/page";
import { StopAllButton } from "./StopAllButton";

const SITE = { slug: "hall", name: "Hall", stop: { active: true, by: "Bo", at: "" } };
let sent: string[];

testsPages();
beforeEach(() => {
  sent = [];
  vi.stubGlobal("fetch", (path: string, { method }: RequestInit) => {
    if (method === "POST") sent.push(path);
    return Promise.resolve(Response.json(path === "/api/sites/hall" ? SITE : []));
  });
});
afterEach(() => {
  useLiveStore.setState(EMPTY);
});

test.each([
  ["live", []],
  ["reconnecting", ["/api/sites/hall/stop"]],
  ["refused", ["/api/sites/hall/stop"]],
] as const)("whether a stopped site is stopped once more while its line is %s", async (connection, wanted) => {
  useLiveStore.setState({ ...EMPTY, site: "hall", connection });
  const queries = makeQueryClient();
  queries.setQueryData(keys.site("hall"), SITE);
  show(<StopAllButton slug="hall" />, queries);
  fireEvent.click(screen.getByText("Stopped"));
  await act(() => new Promise<void>((done) => setTimeout(done)));
  expect(sent).toEqual(wanted);
});
