import { expect, test } from "vitest";
import type { FloorPlan } from "@/map/floor/floor";
import { viewFrom, zoomFor } from "./FollowView";

/** 300 m by 200 m. */
const LARGE: FloorPlan = {
  version: 1,
  width: 30,
  height: 20,
  resolution_m: 10,
  origin: { x: 0, y: -200 },
  places: [],
  cells: new Uint8Array(600),
};

test("a followed view shows as much of the map; nonsense is not followed", () => {
  expect(zoomFor([0, 0, 20], 920, null)).toBe(1);
  expect(zoomFor([0, 0, 0.1], 920, null)).toBe(3);
  expect(viewFrom([1, 2, 10])).toEqual([1, 2, 10]);
  for (const value of [null, [1, 2], [1, 2, 0], [1, "2", 3], [1, 2, Number.NaN]]) expect(viewFrom(value)).toBeNull();
});

test("who sees the whole of a large site is followed to all of it", () => {
  expect(zoomFor([150, -100, 200], 920, LARGE)).toBeCloseTo(0.1);
  expect(zoomFor([150, -100, 200], 920, null)).toBe(0.2);
});
