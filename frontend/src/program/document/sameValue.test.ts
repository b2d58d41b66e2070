import { expect, test } from "vitest";
import { isSameValue } from "./sameValue";

test("values are the same in whatever order their keys come", () => {
  const one = { name: "Carrier", can: ["pick", "drop"], where: { op: ">", args: [{ property: ["a", "b"] }, 30] } };
  const other = { where: { args: [{ property: ["a", "b"] }, 30], op: ">" }, can: ["pick", "drop"], name: "Carrier" };
  expect(isSameValue(one, other)).toBe(true);
  expect(isSameValue({ name: "Carrier", device: undefined }, { name: "Carrier" })).toBe(true);
});

test("values differ in a part, a key, the order or the length of a list, or their type", () => {
  const pairs: readonly (readonly [unknown, unknown])[] = [
    [{ a: { b: 1 } }, { a: { b: 2 } }],
    [{ a: 1 }, { a: 1, b: null }],
    [{ constructor: 1 }, {}],
    [
      [1, 2],
      [2, 1],
    ],
    [[1], [1, 2]],
    [[], {}],
    [null, {}],
    [undefined, null],
    [1, "1"],
  ];
  for (const [one, other] of pairs) {
    expect(isSameValue(one, other)).toBe(false);
    expect(isSameValue(other, one)).toBe(false);
  }
});
