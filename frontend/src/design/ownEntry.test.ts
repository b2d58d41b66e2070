import { expect, test } from "vitest";
import { ownEntry } from "./ownEntry";

test.each(["constructor", "toString", "__proto__"])(
  "a table holds nothing under %s, which every object has",
  (word) => {
    expect(ownEntry({ lamp: 1 }, word)).toBeUndefined();
    expect(ownEntry({ [word]: 1 }, word)).toBe(1);
  },
);

test("where there is no table there is no entry", () => {
  expect([ownEntry(null, "lamp"), ownEntry(undefined, "lamp")]).toEqual([undefined, undefined]);
});
