// @vitest-environment jsdom
import { cleanup, fireEvent, render } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { useFingers } from "@/program/touch/fingers";
import { useLongPress } from "./longPress";

const ask = vi.fn<(press: PointerEvent) => boolean>();

function Asking() {
  useLongPress(ask);
  return null;
}

beforeEach(() => {
  vi.useFakeTimers();
  useFingers.setState({ touching: true, several: false });
  ask.mockReset();
  render(<Asking />);
});
afterEach(() => {
  cleanup();
  vi.useRealTimers();
});

function hold() {
  fireEvent.pointerDown(document.body, { pointerType: "touch", isPrimary: true });
  vi.advanceTimersByTime(600);
  expect(ask).toHaveBeenCalledOnce();
}
/** Whether the end of a touch becomes a tap. */
const taps = () => fireEvent.touchEnd(document.body);

test("the finger that has opened a menu does not press with its lift; the next one does", () => {
  ask.mockReturnValue(true);
  hold();
  expect([taps(), taps()]).toEqual([false, true]);
});

test("a finger that stays where there is no menu presses as ever", () => {
  ask.mockReturnValue(false);
  hold();
  expect(taps()).toBe(true);
});

test("a touch that the browser takes away leaves the next one alone", () => {
  ask.mockReturnValue(true);
  hold();
  fireEvent.touchCancel(document.body);
  expect(taps()).toBe(true);
});
