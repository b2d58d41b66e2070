import { expect, test } from "vitest";
import { nudge, onMap } from "./placement";

const MAP = { width: 200, height: 100, resolution_m: 0.05, origin: { x: -1, y: -4, yaw: 0 } };

test("an arrow key moves a machine by 0.1 m, with Shift by 1 m", () => {
  expect(nudge([2, 3], "ArrowUp", false)).toEqual([2, 3.1]);
  expect(nudge([2, 3], "ArrowLeft", true)).toEqual([1, 3]);
  expect(nudge([2, 3], "Enter", false)).toBeNull();
  expect(nudge([2, 3], "ArrowRight", false, [0.05, 0.5])).toEqual([2.05, 3]);
  expect(nudge([2, 3], "ArrowDown", true, [0.05, 0.5])).toEqual([2, 2.5]);
});

test("a machine stays on the map, to the centimetre", () => {
  expect(onMap([2.004, -0.3333], MAP)).toEqual([2, -0.33]);
  expect(onMap([50, 50], MAP)).toEqual([9, 1]);
  expect(onMap([-50, -50], MAP)).toEqual([-1, -4]);
});
