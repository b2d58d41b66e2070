// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, renderHook } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { makeQueryClient, useMe } from "@/api/queries";
import { useWall } from "./useWall";

/** A line to a server that the test plays. */
class Line {
  static all: Line[] = [];
  onmessage: ((event: { data: string }) => void) | null = null;
  constructor() {
    Line.all.push(this);
  }
  close() {}
}

let isUp: boolean;
let asked: string[];

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", Line);
  vi.stubGlobal("fetch", (path: string) => {
    if (!isUp) return Promise.reject(new TypeError("no network"));
    asked.push(path);
    return Promise.resolve(Response.json(path.endsWith("/me") ? { csrf: "token", user: null, demo_accounts: [] } : {}));
  });
  location.hash = "#code";
  [Line.all, asked, isUp] = [[], [], false];
});
afterEach(() => {
  cleanup();
  vi.useRealTimers();
});

/** A wall screen as the app shows it, which itself asks who is signed in. */
function showWall() {
  const queries = makeQueryClient();
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  return renderHook(() => (useMe(), useWall()), { wrapper });
}

const pass = (ms: number) => act(() => vi.advanceTimersByTimeAsync(ms));

test("a wall screen that is switched on an hour before the server begins by itself", async () => {
  const wall = showWall();
  await pass(3_600_000);
  expect([wall.result.current.line, Line.all.length]).toEqual(["connecting", 0]);
  isUp = true;
  await pass(10_000);
  expect(asked).toEqual(["/api/me", "/api/wall/open"]);
  act(() => Line.all[0]?.onmessage?.({ data: JSON.stringify({ type: "beat" }) }));
  expect([wall.result.current.line, location.hash]).toEqual(["live", ""]);
});

test("while all is stopped a robot that stands waits, and one that still moves does once it stands", async () => {
  isUp = true;
  const wall = showWall();
  await pass(1000);
  const robot = (id: string) => ({
    id,
    name: id,
    kind: "robot",
    status: "busy",
    activity: { code: "driving", args: {} },
  });
  const at = (x: number) => ({ location: { x, y: 0, theta: 0 } });
  const devices = [
    { ...robot("stands"), ...at(0) },
    { ...robot("moves"), ...at(0) },
  ];
  const picture = { type: "picture", site: "Hall", stop: { active: true, at: null }, devices, runs: [], alerts: [] };
  const tell = (message: unknown) => act(() => Line.all[0]?.onmessage?.({ data: JSON.stringify(message) }));
  tell(picture);
  tell({ type: "devices", devices: [{ id: "moves", ...at(1) }] });
  const told = () => wall.result.current.robots(performance.now()).map(({ status }) => status);
  expect(told()).toEqual(["waiting", "busy"]);
  await pass(2000);
  expect(told()).toEqual(["waiting", "waiting"]);
  tell({ ...picture, stop: { active: false, at: null } });
  expect(told()).toEqual(["busy", "busy"]);
});
