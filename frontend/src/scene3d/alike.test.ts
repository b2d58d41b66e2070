import { expect, test } from "vitest";
import { byLook } from "./alike";

test("things of a look come together, in order", () => {
  expect(byLook(["ab", "c", "de", "f"], (each) => String(each.length))).toEqual([
    ["2", ["ab", "de"]],
    ["1", ["c", "f"]],
  ]);
  expect(byLook([], String)).toEqual([]);
});
