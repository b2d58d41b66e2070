import { expect, test } from "vitest";
import { joinComparisons, splitComparisons } from "./conditions";
import type { Value } from "./types";

const hot: Value = { op: ">", args: [{ property: ["oven", "temperature"] }, 40] };
const good: Value = { op: "==", args: [{ property: ["oven", "quality"] }, "ok"] };

test("one comparison goes through the form unchanged", () => {
  const { joiner, comparisons } = splitComparisons(hot);
  expect(joinComparisons(comparisons, joiner)).toEqual(hot);
});

test("several comparisons keep their joiner", () => {
  const both: Value = { op: "or", args: [hot, good] };
  const { joiner, comparisons } = splitComparisons(both);
  expect(joiner).toBe("or");
  expect(joinComparisons(comparisons, joiner)).toEqual(both);
});

test("nothing entered stays nothing, half entered stays half", () => {
  expect(splitComparisons(null).comparisons).toEqual([]);
  expect(joinComparisons([{ left: null, sign: "<", right: null }], "and")).toBeNull();
  expect(joinComparisons([{ left: { param: "x" }, sign: "<", right: null }], "and")).toEqual({
    op: "<",
    args: [{ param: "x" }, null],
  });
});
