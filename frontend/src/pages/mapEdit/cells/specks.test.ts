import { expect, test } from "vitest";
import { drawn, letters } from "./drawn";
import { eraseSpecks } from "./specks";

const NOISY = drawn("#....", "...#.", "..#..", "#...?", "###??");

test("walls of fewer cells than said become floor; corners join", () => {
  const { map, specks } = eraseSpecks(NOISY, 3);
  expect([letters(map), specks]).toEqual([[".....", ".....", ".....", "#...?", "###??"], 2]);
  expect(eraseSpecks(NOISY, 2).specks).toBe(1);
});

test("a speck amid the unknown becomes unknown, and no speck leaves the map as it is", () => {
  expect(letters(eraseSpecks(drawn("???", "?#?", "???"), 2).map)).toEqual(["???", "???", "???"]);
  expect(eraseSpecks(NOISY, 1).map).toBe(NOISY);
});
