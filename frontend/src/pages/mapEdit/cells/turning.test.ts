import { expect, test } from "vitest";
import { drawn, letters } from "./drawn";
import { turnBy, turnQuarter } from "./turning";

const L = drawn("#...", "#...", "##??");

test("a right angle is exact to a cell, and back again gives the very same map", () => {
  const left = turnQuarter(L, "left");
  expect([letters(left), left.origin]).toEqual([["..?", "..?", "..#", "###"], { x: 0.5, y: -0.5 }]);
  expect(turnQuarter(left, "right")).toEqual(L);
  expect(turnBy(L, 90).cells).toEqual(left.cells);
});

test("other angles cut nothing off and leave the corners unknown", () => {
  const turned = turnBy(drawn("##", "##"), 45);
  expect(letters(turned)).toEqual(["?#?", "###", "?#?"]);
  expect(turned.origin).toEqual({ x: -0.5, y: -0.5 });
});

test("no turn leaves the map as it is", () => {
  for (const degrees of [0, 360, Number.NaN]) expect(turnBy(L, degrees)).toBe(L);
});
