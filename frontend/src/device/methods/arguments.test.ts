import { expect, test } from "vitest";
import type { DeviceMethod, MethodParameter } from "@/api/types";
import { emptyForm, readArguments } from "./arguments";

const NUMBER: MethodParameter = {
  name: "time",
  type: "number",
  unit: "MIN",
  minimum: 1,
  maximum: 60,
  options: [],
  required: true,
};
const method = (...parameters: Partial<MethodParameter>[]): DeviceMethod => ({
  name: "mix",
  title: "",
  topic: "",
  message_type: "",
  parameters: parameters.map((each) => ({ ...NUMBER, ...each })),
});

test("a form begins empty, with switches off", () => {
  expect(emptyForm(method({}, { name: "wet", type: "boolean" }))).toEqual({ time: "", wet: false });
});

test("what is typed becomes arguments of the parameters' types", () => {
  const all = method(
    {},
    { name: "wet", type: "boolean" },
    { name: "to", type: "location" },
    { name: "o", type: "text" },
  );
  const typed = { time: "2.5", wet: false, to: "3.2, -4.1", o: "box" };
  expect(readArguments(all, typed)).toEqual({ args: { time: 2.5, wet: false, to: [3.2, -4.1], o: "box" } });
});

test("what is empty is missing only where it is needed", () => {
  expect(readArguments(method({}), { time: "" })).toEqual({ problems: { time: "missing" } });
  expect(readArguments(method({ required: false }), { time: "" })).toEqual({ args: {} });
  expect(readArguments(method({ required: false }), {})).toEqual({ args: {} });
});

test.each([
  ["x", "number"],
  [0.5, "below"],
  [61, "above"],
])("the number %s is refused as %s", (typed, problem) => {
  expect(readArguments(method({}), { time: typed })).toEqual({ problems: { time: problem } });
});

test.each([
  ["3,2; -4,1", [3.2, -4.1]],
  ["3,2 -4,1", [3.2, -4.1]],
  ["3.2,-4.1", [3.2, -4.1]],
  ["3.2 , -4", [3.2, -4]],
  ["3, 2", [3, 2]],
  ["1, 2, 0, 1.5", [1, 2, 0, 1.5]],
  [" 3;2; ", [3, 2]],
])("%s is read as it is meant", (typed, to) => {
  expect(readArguments(method({ name: "to", type: "location" }), { to: typed })).toEqual({ args: { to } });
});

test.each(["3", "3, x", "1 2 3 4 5", "3,2", "3,2,-4,1", "1, 2,5", "1.5 2,5", "1,2,3 4", "0x3 4", ","])(
  "%s is no location",
  (typed) => {
    expect(readArguments(method({ name: "to", type: "location" }), { to: typed })).toEqual({
      problems: { to: "location" },
    });
  },
);

test("a parameter may have the name of what every object has", () => {
  const one = method({ name: "constructor" });
  expect(readArguments(one, {})).toEqual({ problems: { constructor: "missing" } });
  expect(readArguments(one, { constructor: "4" })).toEqual({ args: { constructor: 4 } });
});
