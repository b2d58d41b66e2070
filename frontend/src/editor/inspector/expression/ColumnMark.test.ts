import { expect, test } from "vitest";
import { wordAt } from "./ColumnMark";

test("the word at a column is what is marked, else the sign there", () => {
  expect(wordAt("oven.heat > 60", 1)).toBe("oven.heat");
  expect(wordAt("oven.heat > 60", 11)).toBe(">");
  expect(wordAt("1 + grün", 5)).toBe("grün");
});

test("beyond the end and on a space a blank is marked", () => {
  expect(wordAt("1 +", 4)).toBe("\u00a0");
  expect(wordAt("1 +", 2)).toBe("\u00a0");
});
