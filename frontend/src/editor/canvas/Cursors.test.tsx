// @vitest-environment jsdom
import { act, cleanup, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { ViewportCell } from "@/map/plane/viewport";
import { StageContext, type StageHandle } from "@/program/canvas/stageContext";
import type { SharedProgram } from "../shared/sharedProgram";
import { Cursors } from "./Cursors";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => {
  cleanup();
  vi.useRealTimers();
});

test("a pointer that rests goes away after half a minute and comes back when it moves, alone", () => {
  const states = new Map(
    [1, 2].map((client) => [client, { user: { name: `Person ${client}` }, cursor: [client, -1] }]),
  );
  const changed: (() => void)[] = [];
  const awareness = {
    getStates: () => states,
    on: (_event: string, listener: () => void) => void changed.push(listener),
    off: () => undefined,
  };
  const shared = { doc: { clientID: 9 }, awareness } as unknown as SharedProgram;
  const stage = { viewport: new ViewportCell() } as unknown as StageHandle;
  render(
    <StageContext value={stage}>
      <Cursors shared={shared} />
    </StageContext>,
  );
  const names = () => screen.queryAllByText(/Person/).map((name) => name.textContent);
  const pass = (seconds: number) => act(() => void vi.advanceTimersByTime(1000 * seconds));
  const move = (client: number, x: number) => {
    states.set(client, { user: { name: `Person ${client}` }, cursor: [x, -1] });
    act(() => changed.at(-1)?.());
  };
  pass(20);
  move(2, 5);
  expect(names()).toEqual(["Person 1", "Person 2"]);
  pass(14);
  expect(names()).toEqual(["Person 2"]);
  pass(24);
  expect(names()).toEqual([]);
  pass(60);
  expect(names()).toEqual([]);
  move(1, 3);
  expect(names()).toEqual(["Person 1"]);
});
