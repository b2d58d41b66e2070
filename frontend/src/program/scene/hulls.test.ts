import { expect, test } from "vitest";
import { outlinesAround } from "./hulls";

test("one box has an outline of four corners", () => {
  expect(outlinesAround([{ left: 0, right: 46, top: 0, bottom: 23 }])).toEqual([
    [
      { x: 0, y: 0 },
      { x: 46, y: 0 },
      { x: 46, y: 23 },
      { x: 0, y: 23 },
    ],
  ]);
});

test("a notch between two boxes of one row is filled", () => {
  const boxes = [
    { left: 0, right: 46, top: 0, bottom: 46 },
    { left: 92, right: 138, top: 0, bottom: 46 },
    { left: 0, right: 138, top: 46, bottom: 69 },
  ];
  expect(outlinesAround(boxes)).toEqual([
    [
      { x: 0, y: 0 },
      { x: 138, y: 0 },
      { x: 138, y: 69 },
      { x: 0, y: 69 },
    ],
  ]);
});

test("an L keeps its corner", () => {
  const boxes = [
    { left: 0, right: 23, top: 0, bottom: 46 },
    { left: 0, right: 69, top: 46, bottom: 69 },
  ];
  expect(outlinesAround(boxes)[0]).toHaveLength(6);
});
