import { expect, test } from "vitest";
import { choiceOf, choiceValue, typedValue, type Choice } from "./choices";
import type { Value } from "@/program/document/document";

const charged: Choice = { reading: "battery", sign: ">", value: 30 };

test("a choice goes through the form unchanged", () => {
  const where = choiceValue(charged, "arm");
  expect(where).toEqual({ op: ">", args: [{ property: [{ role: "arm" }, "battery"] }, 30] });
  expect(choiceOf(where, "arm")).toEqual(charged);
  expect(choiceOf(choiceValue({ ...charged, value: null }, "arm"), "arm")).toEqual({ ...charged, value: null });
});

test("what the form cannot show is none of its choices", () => {
  const battery: Value = { property: [{ role: "arm" }, "battery"] };
  const others: (Value | undefined)[] = [
    undefined,
    null,
    "battery > 30",
    battery,
    choiceValue(charged, "robot"),
    { op: "and", args: [choiceValue(charged, "arm"), choiceValue(charged, "arm")] },
    { op: ">", args: [30, battery] },
    { op: ">", args: [battery, { quantity: [30, "PERCENT"] }] },
    { op: ">", args: [{ property: ["oven", "temperature"] }, 3] },
    { op: "in", args: [battery, 3] },
  ];
  expect(others.map((each) => choiceOf(each, "arm"))).toEqual(others.map(() => null));
});

test("what is typed is a number where the reading is one", () => {
  expect(["30", " 2,5 ", "", "full", "1e999"].map((each) => typedValue(each, "number"))).toEqual([
    30,
    2.5,
    null,
    null,
    null,
  ]);
  expect(["Yes", "nein", "true", "perhaps"].map((each) => typedValue(each, "boolean"))).toEqual([
    true,
    false,
    true,
    null,
  ]);
  expect(["box", " ", "30"].map((each) => typedValue(each, "text"))).toEqual(["box", null, "30"]);
});
