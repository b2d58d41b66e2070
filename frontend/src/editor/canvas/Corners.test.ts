import { expect, test } from "vitest";
import { nearestLeg, pushed, withCorner, withoutCorner } from "./Corners";

test("corners are pushed, added and taken away one at a time", () => {
  const square = [
    [0, 0],
    [1, 0],
    [1, 1],
  ] as const;
  expect(pushed(square, 1, [0.1, -0.2])[1]).toEqual([1.1, -0.2]);
  expect(withCorner(square, 1, [0.5, 0])).toEqual([
    [0, 0],
    [0.5, 0],
    [1, 0],
    [1, 1],
  ]);
  expect(withoutCorner(square, 0)).toEqual([
    [1, 0],
    [1, 1],
  ]);
});

test("a path that is dragged bends on the leg under the pointer", () => {
  const path = [
    { x: 0, y: 0 },
    { x: 100, y: 0 },
    { x: 100, y: 100 },
  ];
  expect([nearestLeg(path, { x: 40, y: 5 }), nearestLeg(path, { x: 95, y: 60 })]).toEqual([0, 1]);
});
