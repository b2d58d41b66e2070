import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { FrameLoop } from "./frameLoop";

const FRAME_MS = 16;

beforeEach(() => {
  vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout"] });
  vi.stubGlobal("requestAnimationFrame", (step: (now: number) => void) => setTimeout(() => step(0), FRAME_MS));
  vi.stubGlobal("cancelAnimationFrame", clearTimeout);
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function counted(changes: () => boolean) {
  const look = vi.fn(changes);
  return { look, loop: new FrameLoop(look) };
}

test("what changes is looked at in each frame", () => {
  const { look, loop } = counted(() => true);
  vi.advanceTimersByTime(1600);
  expect(look).toHaveBeenCalledTimes(100);
  loop.stop();
});

test("what stands still is looked at ten times a second, and in each frame again once it moves", () => {
  let moving = false;
  const { look, loop } = counted(() => moving);
  vi.advanceTimersByTime(FRAME_MS * 30);
  look.mockClear();
  vi.advanceTimersByTime((100 + FRAME_MS) * 10);
  expect(look).toHaveBeenCalledTimes(10);
  moving = true;
  vi.advanceTimersByTime(100 + FRAME_MS);
  look.mockClear();
  vi.advanceTimersByTime(FRAME_MS * 5);
  expect(look).toHaveBeenCalledTimes(5);
  loop.stop();
});

test("who wakes it is shown at the next frame, and nothing is looked at twice in one", () => {
  const { look, loop } = counted(() => false);
  vi.advanceTimersByTime(FRAME_MS * 30 + 10);
  look.mockClear();
  loop.wake();
  loop.wake();
  vi.advanceTimersByTime(FRAME_MS);
  expect(look).toHaveBeenCalledTimes(1);
  loop.stop();
});

test("when it is stopped nothing is looked at any more", () => {
  const { look, loop } = counted(() => false);
  vi.advanceTimersByTime(1000);
  loop.stop();
  look.mockClear();
  vi.advanceTimersByTime(1000);
  expect(look).not.toHaveBeenCalled();
});
