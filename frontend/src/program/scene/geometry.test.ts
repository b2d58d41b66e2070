import { expect, test } from "vitest";
import { boxAt, elbow, gap, nearestOn } from "./geometry";
import { separateLanes } from "./lanes";

test("boxes above each other are joined by a straight line", () => {
  const path = elbow(boxAt({ x: 0, y: 0 }, 40, 20), boxAt({ x: 10, y: 100 }, 40, 20));
  expect(path).toEqual([
    { x: 5, y: 10 },
    { x: 5, y: 90 },
  ]);
});

test("boxes in different rows and columns are joined by a corner", () => {
  const path = elbow(boxAt({ x: 0, y: 0 }, 40, 20), boxAt({ x: 200, y: 100 }, 40, 20));
  expect(path).toEqual([
    { x: 0, y: 10 },
    { x: 0, y: 100 },
    { x: 180, y: 100 },
  ]);
});

test("the gap between boxes that overlap is nothing", () => {
  expect(gap(boxAt({ x: 0, y: 0 }, 10, 10), boxAt({ x: 5, y: 5 }, 10, 10))).toBe(0);
  expect(gap(boxAt({ x: 0, y: 0 }, 10, 10), boxAt({ x: 13, y: 14 }, 10, 10))).toBe(5);
});

test("a chip is brought to the nearest point of its route", () => {
  const route = [
    { x: 0, y: 0 },
    { x: 100, y: 0 },
  ];
  expect(nearestOn(route, { x: 30, y: 12 })).toEqual({ at: { x: 30, y: 0 }, off: 12 });
});

test("a second route along the same line gets a lane beside it", () => {
  const route = [
    { x: 0, y: 50 },
    { x: 0, y: 0 },
    { x: 100, y: 0 },
    { x: 100, y: 50 },
  ];
  const [first, second] = separateLanes([route, route]);
  expect(first).toEqual(route);
  expect(second?.[1]).toEqual({ x: 0, y: 15 });
  expect(second?.[2]).toEqual({ x: 100, y: 15 });
});
