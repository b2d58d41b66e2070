import { expect, test } from "vitest";
import { freeMiddle } from "./newPlace";

const map = { version: 1, width: 5, height: 3, resolution_m: 1, origin: { x: -1, y: 2 }, places: [] };

test("a place that nobody has pointed at stands on the free floor nearest to the middle", () => {
  const cells = new Uint8Array(15).fill(100);
  cells[5] = 0; // second row from below, first column
  cells[14] = 0; // top row, last column
  cells[7] = 255; // the middle is not known
  expect(freeMiddle({ ...map, cells })).toEqual([-0.5, 3.5]);
  cells[7] = 0;
  expect(freeMiddle({ ...map, cells })).toEqual([1.5, 3.5]);
});

test("where nothing is free it stands in the middle", () => {
  expect(freeMiddle({ ...map, cells: new Uint8Array(15).fill(100) })).toEqual([1.5, 3.5]);
});
