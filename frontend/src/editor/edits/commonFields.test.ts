import { expect, test } from "vitest";
import type { Step } from "@/program/document/document";
import { commonFields, setForAll } from "./commonFields";

const step = (kind: Step["kind"], params: Step["params"]): Step => ({ kind, pos: [0, 0], place: null, params });
const said = (steps: readonly Step[]) =>
  commonFields(steps).map(({ field, value, mixed }) => [field.name, value, mixed]);

test("steps of one kind have all their fields in common; values that differ are mixed", () => {
  const two = [step("wait", { duration: 60 }), step("wait", { duration: 90 })];
  expect(said(two)).toEqual(expect.arrayContaining([["duration", undefined, true]]));
  const same = [step("notify", { message: "Hi", level: "info" }), step("notify", { message: "Hi", level: "info" })];
  expect(said(same)).toEqual([
    ["message", "Hi", false],
    ["level", "info", false],
  ]);
});

test("steps of different kinds have in common what both are told", () => {
  const pick = step("pick", { role: "robot", at: { device: "a" }, object: "box", quantity: 1 });
  const carry = step("pick_and_drop", { role: "robot", source: { device: "a" }, object: "box", quantity: 2 });
  expect(said([pick, carry])).toEqual([
    ["role", "robot", false],
    ["object", "box", false],
    ["quantity", undefined, true],
  ]);
  expect(said([pick, step("wait", {})])).toEqual([]);
  // A pick takes only machines that give, a drop only those that take.
  expect(said([pick, step("drop", { role: "robot", at: { device: "a" } })]).map(([name]) => name)).not.toContain("at");
});

test("a value is common in whatever order its keys come", () => {
  const until = (value: unknown) => step("wait", { until: value });
  const two = [until({ op: ">", args: [1, 2] }), until({ args: [1, 2], op: ">" })];
  expect(said(two)).toEqual(expect.arrayContaining([["until", { op: ">", args: [1, 2] }, false]]));
});

test("one value is given to all of them in one edit", () => {
  expect(setForAll(["a", "b"], "quantity", 2)).toEqual([
    { do: "set_param", id: "a", name: "quantity", value: 2 },
    { do: "set_param", id: "b", name: "quantity", value: 2 },
  ]);
});
