import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { usesOf, variablesOf } from "./uses";

const step = (kind: Step["kind"], params: Step["params"]): Step => ({ kind, pos: [0, 0], place: null, params });
const document: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  roles: { robot: { name: "Robot", device: "turtle1" } },
  parameters: { p: { name: "boxes", type: "number" } },
  zones: {},
  steps: {
    cure: step("operate", { device: { device: "oven" }, method: "cure", args: { time: { param: "boxes" } } }),
    read: step("wait", { until: { op: ">", args: [{ property: ["oven", "temperature"] }, 40] } }),
    drive: step("move", { role: "robot", to: { place: "door" } }),
    own: step("operate", { device: { role: "robot" }, method: "spin", args: {} }),
    set: step("set", { variable: "count", value: 1 }),
    tell: step("notify", { message: { op: "text", args: ["Done: ", { param: "count" }] } }),
    why: step("notify", { message: { param: "problem.text" } }),
    mix: step("call", { function: "f1", args: {}, result: "shade" }),
    clean: step("cover", { role: "other", zone: "z1" }),
    inside: step("if", { condition: { op: "in", args: [{ at: { role: "robot" } }, { zone: "z1" }] } }),
    named: step("call", { function: "f1", args: { zone: "z1", role: "other" } }),
  },
};

test("a device is used by the steps that name it, read it, or are done by the role that it is bound to", () => {
  expect(usesOf(document, { kind: "device", id: "oven" })).toEqual(["cure", "read"]);
  expect(usesOf(document, { kind: "device", id: "turtle1" })).toEqual(["drive", "own"]);
  expect(usesOf(document, { kind: "device", id: "temperature" })).toEqual([]);
});

test("places, zones and functions are used where they are named", () => {
  expect(usesOf(document, { kind: "place", id: "door" })).toEqual(["drive"]);
  expect(usesOf(document, { kind: "zone", id: "z1" })).toEqual(["clean", "inside"]);
  expect(usesOf(document, { kind: "function", id: "f1" })).toEqual(["mix", "named"]);
});

test("a variable is used where it is set and where it is read, and all names are found", () => {
  expect(usesOf(document, { kind: "variable", id: "count" })).toEqual(["set", "tell"]);
  expect(usesOf(document, { kind: "variable", id: "boxes" })).toEqual(["cure"]);
  expect(usesOf(document, { kind: "variable", id: "problem" })).toEqual(["why"]);
  expect(variablesOf(document)).toEqual(["boxes", "count", "problem", "shade"]);
});

test("the item and the round of a For-each are used by it, and a parameter of another step that is called so is no name", () => {
  const each = step("for_each", { variable: "box", index: "round" });
  const odd = step("wait", { variable: "not", duration: 1 });
  const looping = { ...EMPTY_DOCUMENT, steps: { each, odd } };
  expect(variablesOf(looping)).toEqual(["box", "round"]);
  for (const id of ["box", "round"]) expect(usesOf(looping, { kind: "variable", id })).toEqual(["each"]);
});
