import { expect, test } from "vitest";
import { plannedBends } from "./stepPaths";

test("the bends of a planned way begin a drawn one; a straight way gives one in its middle", () => {
  const planned = plannedBends([
    { x: 0, y: 0 },
    { x: 46, y: 0 },
    { x: 92, y: 0 },
    { x: 92, y: 92 },
  ]);
  expect(planned).toEqual([[2, 0]]);
  expect(
    plannedBends([
      { x: 0, y: 0 },
      { x: 92, y: 0 },
    ]),
  ).toEqual([[1, 0]]);
});
