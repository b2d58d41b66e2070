import { expect, test } from "vitest";
import { drawn, letters } from "./drawn";
import { fitsTurned, turnBy, turnQuarter } from "./turning";

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

test("a map that would have more than 4096 cells on a side is left as it is", () => {
  const long = { ...L, width: 4096, height: 300, cells: new Uint8Array(4096 * 300) };
  expect([0, 5, 90, Number.NaN].map((degrees) => fitsTurned(long, degrees))).toEqual([true, false, true, true]);
  expect(turnBy(long, 5)).toBe(long);
});
