import { expect, test } from "vitest";
import { linesOf, onScreen } from "./InSmall";

test("words of a map in small stay as large as they can be read, up to a limit", () => {
  expect(onScreen(1)).toBe(1);
  expect(onScreen(0.5) * 0.5).toBeCloseTo(0.87);
  expect(onScreen(0.1)).toBe(2.4);
});

test("names that would lie over each other stand in lines below each other, all others where they are", () => {
  const at = (x: number, y = 0) => ({ x, y, width: 60 });
  expect(linesOf([at(0), at(50), at(100)], 15)).toEqual([0, 1, 0]);
  expect(linesOf([at(0), at(20), at(40)], 15)).toEqual([0, 1, 2]);
  expect(linesOf([at(0), at(20, 15), at(20, 200)], 15)).toEqual([0, 0, 0]);
});
