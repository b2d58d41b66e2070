import { expect, test } from "vitest";
import {
  areaOf,
  holds,
  middleOf,
  rectangle,
  shifted,
  squareAt,
  withCorner,
  withMoved,
  withoutCorner,
  type Outline,
} from "./outline";

const map = { width: 10, height: 8, resolution_m: 1, origin: { x: -1, y: 2, yaw: 0 } };
const box: Outline = rectangle([3, 6], [1, 4]);

test("a rectangle has the same corners whichever way it was dragged", () => {
  expect(box).toEqual([
    [1, 4],
    [3, 4],
    [3, 6],
    [1, 6],
  ]);
  expect(rectangle([1, 4], [3, 6])).toEqual(box);
});

test("a square at the edge of the map is cut off there", () => {
  expect(squareAt([4, 6], map)).toEqual(rectangle([3, 5], [5, 7]));
  expect(squareAt([-0.5, 2.5], map)).toEqual(rectangle([-1, 2], [0.5, 3.5]));
});

test("a zone is moved as a whole and stops at the edge of the map with its shape as it was", () => {
  expect(shifted(box, [0.5, -0.25], map)).toEqual(rectangle([1.5, 3.75], [3.5, 5.75]));
  expect(shifted(box, [100, -100], map)).toEqual(rectangle([7, 2], [9, 4]));
});

test("corners are moved, added and taken away, but never below three", () => {
  expect(withMoved(box, 1, [4, 4])[1]).toEqual([4, 4]);
  expect(middleOf(box, 3)).toEqual([1, 5]);
  expect(withCorner(box, 1, [2, 4]).slice(0, 3)).toEqual([
    [1, 4],
    [2, 4],
    [3, 4],
  ]);
  const three = withoutCorner(box, 0);
  expect(three).toEqual(box.slice(1));
  expect(withoutCorner(three, 0)).toBe(three);
});

test("the area and what lies inside follow the outline, also where it has a notch", () => {
  const notched: Outline = [
    [0, 0],
    [4, 0],
    [4, 4],
    [2, 1],
    [0, 4],
  ];
  expect(areaOf(box)).toBe(4);
  expect(areaOf(notched)).toBe(10);
  expect([holds(notched, [1, 1]), holds(notched, [2, 2]), holds(notched, [3.5, 2]), holds(notched, [5, 1])]).toEqual([
    true,
    false,
    true,
    false,
  ]);
});
