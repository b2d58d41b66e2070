import { expect, test } from "vitest";
import { PIXELS_PER_METRE } from "@/map/plane/projection";
import { boxOf, extentOf, FAINTEST, type Heat, mostDrives, STRONGEST, strengthOf } from "./heatPainter";

const HEAT: Heat = {
  square_m: 0.25,
  squares: [
    [-1, 4, 3],
    [2, 6, 12],
    [2, 4, 1],
  ],
};

test("the square with the most drives has the strongest colour, one drive the faintest", () => {
  expect(mostDrives(HEAT)).toBe(12);
  expect([1, 12].map((drives) => strengthOf(drives, 12))).toEqual([FAINTEST, STRONGEST]);
  expect(strengthOf(6, 12)).toBeGreaterThan(strengthOf(5, 12));
});

test("where no square has more than one drive, each is the strongest", () => {
  expect(strengthOf(1, 1)).toBe(STRONGEST);
});

test("the picture has a square of room on each side, in which the outermost fade", () => {
  expect(extentOf(HEAT)).toEqual({ column: -2, row: 3, columns: 6, rows: 5 });
});

test("it lies on the floor where its squares are, y up", () => {
  const side = PIXELS_PER_METRE / 4;
  expect(boxOf(HEAT)).toEqual({ left: -2 * side, top: -8 * side, right: 4 * side, bottom: -3 * side });
});
