import { expect, test } from "vitest";
import { placesOf } from "./places";

const at = (x: number, y: number) => ({ x, y, width: 100, height: 20 });

test("names that are apart stay where they are", () => {
  expect(placesOf([at(0, 0), at(120, 0), at(0, 40)])).toEqual([0, 0, 0]);
});

test("one that would cover another is moved above it, and the next above both", () => {
  expect(placesOf([at(0, 0), at(30, 2), at(10, 4)])).toEqual([0, 25, 50]);
});

test("one for which there is no place near is not shown, and takes none", () => {
  expect(placesOf([at(0, 0), at(0, 0), at(0, 0), at(0, 0), at(103, 0)])).toEqual([0, 23, 46, null, 0]);
});

test("a crowd leaves names of which none covers another", () => {
  const crowd = Array.from({ length: 80 }, (_, index) => at((index * 37) % 600, (index * 53) % 300));
  const shown = placesOf(crowd).flatMap((up, index) => {
    const name = crowd[index];
    return up === null || !name ? [] : [{ ...name, y: name.y - up }];
  });
  expect(shown.length).toBeGreaterThan(20);
  for (const [index, one] of shown.entries())
    for (const other of shown.slice(index + 1))
      expect(Math.abs(one.x - other.x) >= 100 || Math.abs(one.y - other.y) >= 20).toBe(true);
});
