import { expect, test } from "vitest";
import { viewFrom, zoomFor } from "./FollowView";

test("a followed view shows as much of the map; nonsense is not followed", () => {
  expect(zoomFor([0, 0, 20], 920)).toBe(1);
  expect(zoomFor([0, 0, 0.1], 920)).toBe(3);
  expect(viewFrom([1, 2, 10])).toEqual([1, 2, 10]);
  for (const value of [null, [1, 2], [1, 2, 0], [1, "2", 3], [1, 2, Number.NaN]]) expect(viewFrom(value)).toBeNull();
});
