import { expect, test } from "vitest";
import { drawn, letters } from "./drawn";
import { crop, drawAlong, fillBox, rescale } from "./edits";

const EMPTY = drawn(".....", ".....", ".....", ".....", ".....");

test("a wall is drawn along a line, as wide as is said", () => {
  const thin = drawAlong(EMPTY, [[0.5, 2.5], [4.5, 2.5]], 0.05, "wall"); // prettier-ignore
  expect(letters(thin)).toEqual([".....", ".....", "#####", ".....", "....."]);
  const wide = drawAlong(EMPTY, [[2.5, 0.5], [2.5, 4.5]], 2, "wall"); // prettier-ignore
  expect(letters(wide)).toEqual([".###.", ".###.", ".###.", ".###.", ".###."]);
});

test("a dot of the brush takes noise away, and what is off the map changes nothing", () => {
  const noisy = drawn("#....", ".....", "..#..", ".....", ".....");
  expect(letters(drawAlong(noisy, [[2.5, 2.5]], 1, "floor"))).toEqual(["#....", ".....", ".....", ".....", "....."]);
  expect(drawAlong(noisy, [[-9, -9]], 1, "floor")).toBe(noisy);
  expect(drawAlong(noisy, [[4.5, 0.5]], 1, "floor")).toBe(noisy);
});

test("a box is filled whichever corner comes first, and cut off at the map's edge", () => {
  expect(letters(fillBox(EMPTY, [3.5, 4.5], [9, 3.2], "unknown"))).toEqual([
    "...??",
    "...??",
    ".....",
    ".....",
    ".....",
  ]);
  expect(fillBox(EMPTY, [8, 8], [9, 9], "wall")).toBe(EMPTY);
});

test("what is left of a cropped map keeps its coordinates", () => {
  const map = { ...drawn("#....", ".....", ".....", ".....", "....#"), resolution_m: 0.05, origin: { x: -1, y: 2 } };
  const left = crop(map, [-0.99, 2.01], [-0.81, 2.19]);
  expect([left.width, left.height, left.origin]).toEqual([4, 4, { x: -1, y: 2 }]);
  const right = crop(map, [-0.94, 2.06], [5, 5]);
  expect([letters(right), right.origin]).toEqual([["....", "....", "....", "...."], { x: -0.95, y: 2.05 }]);
  expect(crop(map, [-0.99, 2.01], [-0.9, 2.1])).toBe(map);
});

test("a map that is scaled keeps its cells and the zero of its coordinates", () => {
  const map = { ...EMPTY, resolution_m: 0.05, origin: { x: -1, y: 2 } };
  expect(rescale(map, 1.5)).toEqual({ ...map, resolution_m: 0.075, origin: { x: -1.5, y: 3 } });
  expect(rescale(map, 1000)).toBe(map);
  expect(rescale(map, Number.NaN)).toBe(map);
});
