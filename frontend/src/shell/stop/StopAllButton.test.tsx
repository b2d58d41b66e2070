// @vitest-environment jsdom
import { act, fireEvent, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { Device } from "@/api/types";
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

test("the dialog tells robots that stand as held", async () => {
  const known = { id: "robot", name: "Robin", kind: "robot", lifecycle: "approved", status: "busy", properties: [] };
  const activity = { code: "driving", args: {} };
  const device = { ...known, doing: "Driving", activity, carrying: {}, location: { x: 0, y: 0, z: 0, theta: 0 } };
  const queries = makeQueryClient();
  queries.setQueryData(keys.site("hall"), SITE);
  queries.setQueryData(keys.devices("hall"), [device]);
  const deviceById = { robot: device as unknown as Device };
  useLiveStore.setState({ ...EMPTY, site: "hall", connection: "live", deviceById });
  useLiveStore.setState({ stop: SITE.stop });
  show(<StopAllButton slug="hall" />, queries);
  expect(await screen.findByText("Held")).toBeDefined();
  expect(screen.queryByText("Driving")).toBeNull();
});
