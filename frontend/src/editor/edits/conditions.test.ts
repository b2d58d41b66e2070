import { expect, test } from "vitest";
import { fitsForm, joinComparisons, readingsOf, splitComparisons } from "./conditions";
import type { Value } from "@/program/document/document";

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

test("the form shows comparisons of readings with any value, joined by one word", () => {
  const shown: Value[] = [
    null,
    hot,
    { op: "and", args: [hot, good, null] },
    { op: ">", args: [{ property: ["oven", "temperature"] }, { quantity: [1, "MIN"] }] },
    { op: "<", args: [{ property: [{ role: "robot" }, "battery"] }, 30] },
  ];
  expect(shown.map(fitsForm)).toEqual(shown.map(() => true));
  const written: Value[] = [
    true,
    { op: "not", args: [hot] },
    { op: "and", args: [hot, { op: "or", args: [hot, good] }] },
    { op: ">", args: [40, { property: ["oven", "temperature"] }] },
    { op: "in", args: [{ at: { role: "robot" } }, { zone: "z1" }] },
    { op: ">", args: [{ op: "now", args: [] }, 3] },
  ];
  expect(written.map(fitsForm)).toEqual(written.map(() => false));
});

test("each reading of a value is found once", () => {
  expect(readingsOf({ op: "and", args: [hot, good, hot] })).toEqual([
    ["oven", "temperature"],
    ["oven", "quality"],
  ]);
  expect(readingsOf({ property: [{ param: "mixer" }, "level"] })).toEqual([]);
  const charge: Value = { property: [{ role: "robot" }, "battery"] };
  expect(readingsOf(charge, { robot: { device: "robot01" } })).toEqual([["robot01", "battery"]]);
  expect(readingsOf(charge, { robot: { can: ["pick"] } })).toEqual([]);
});
