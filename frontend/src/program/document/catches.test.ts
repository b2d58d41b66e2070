/** The catches of a Try: which there are, and what adds and removes one. */
import { expect, test } from "vitest";
import { addedCatch, catchesOf, isCatch, kindsOf, removedCatch } from "./catches";

test("a catch is there by its own parameter; old documents have the first", () => {
  expect(catchesOf({})).toEqual(["catch"]);
  expect(catchesOf({ catch: false })).toEqual([]);
  expect(catchesOf({ catch: false, kinds: ["failed"], kinds2: [] })).toEqual(["catch2"]);
  expect(catchesOf({ kinds3: [], kinds2: null, kinds9: [], kinds4: "failed" })).toEqual(["catch", "catch3"]);
});

test("the branches that may be catches, with their parameters", () => {
  expect(["catch", "catch2", "catch8", "catch1", "catch9", "body", undefined].map(isCatch)).toEqual([
    ...[true, true, true],
    ...[false, false, false, false],
  ]);
  expect([kindsOf("catch"), kindsOf("catch2")]).toEqual(["kinds", "kinds2"]);
});

test("one more stands behind the others; in a gap only when there is no number left", () => {
  expect(addedCatch({ catch: false })).toEqual(["catch", null]);
  expect(addedCatch({})).toEqual(["kinds2", []]);
  expect(addedCatch({ kinds2: null, kinds3: [] })).toEqual(["kinds4", []]);
  expect(addedCatch({ catch: false, kinds8: [] })).toEqual(["catch", null]);
  expect(addedCatch({ kinds2: [], kinds8: [] })).toEqual(["kinds3", []]);
  const all = Object.fromEntries([2, 3, 4, 5, 6, 7, 8].map((number) => [`kinds${number}`, []]));
  expect(addedCatch(all)).toBeNull();
});

test("who comes later at a Try leaves the next number to who was there first, as long as there is room", () => {
  expect([0, 1, 2].map((turn) => addedCatch({}, turn))).toEqual([
    ["kinds2", []],
    ["kinds3", []],
    ["kinds4", []],
  ]);
  expect(addedCatch({ catch: false }, 1)).toEqual(["kinds2", []]);
  expect(addedCatch({ kinds7: [] }, 1)).toEqual(["kinds8", []]);
  expect(addedCatch({ kinds8: [] }, 1)).toEqual(["kinds2", []]);
});

test("what removes a catch takes it away and leaves the others", () => {
  const params = { kinds: ["failed"], kinds2: ["offline"], kinds3: [] };
  const without = (branch: string) => catchesOf({ ...params, ...Object.fromEntries([removedCatch(branch)]) });
  expect(["catch", "catch2", "catch3"].map(without)).toEqual([
    ["catch2", "catch3"],
    ["catch", "catch3"],
    ["catch", "catch2"],
  ]);
});
