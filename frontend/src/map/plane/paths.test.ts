import { expect, test } from "vitest";
import { chevrons, pathLength, pointAlong, roundedPath, simplified, stretches } from "./paths";

const corner = [
  { x: 0, y: 0 },
  { x: 100, y: 0 },
  { x: 100, y: 60 },
];

test("a corner is rounded, its ends stay", () => {
  expect(roundedPath(corner, 10)).toBe("M0 0L90 0Q100 0 100 10L100 60");
});

test("a corner is rounded no farther than half the shorter leg", () => {
  expect(roundedPath(corner, 500)).toBe("M0 0L70 0Q100 0 100 30L100 60");
});

test("points along the route know the way they go", () => {
  expect(pointAlong(corner, 130)).toEqual({ x: 100, y: 30, angle: 90 });
  expect(pathLength(corner)).toBe(160);
});

test("the longest stretch comes first", () => {
  expect(stretches(corner)[0]?.length).toBe(100);
});

test("short routes have no chevrons", () => {
  expect(chevrons(corner)).toEqual([]);
  expect(
    chevrons([
      { x: 0, y: 0 },
      { x: 500, y: 0 },
    ]),
  ).toHaveLength(2);
});

test("a point on a straight line is left out", () => {
  expect(
    simplified([
      { x: 0, y: 0 },
      { x: 5, y: 0 },
      { x: 9, y: 0 },
    ]),
  ).toEqual([
    { x: 0, y: 0 },
    { x: 9, y: 0 },
  ]);
});
