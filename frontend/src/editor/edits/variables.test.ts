import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { asName, freshName, knownNames, namesSet } from "./variables";

function step(kind: string, place: Step["place"], params: Step["params"] = {}): Step {
  return { kind, place, pos: null, params };
}

const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  parameters: { p: { name: "boxes", type: "number" } },
  functions: {
    mix: { name: "mix", parameters: [{ name: "minutes", type: "number", unit: "MIN" }], result: { type: "number" } },
  },
  steps: {
    ask: step("ask", ["program", "body", "A"], { variable: "dry", answer: { type: "choice", options: ["a"] } }),
    loop: step("for_each", ["program", "body", "B"], { variable: "mixer", items: [{ at: { device: "m1" } }] }),
    counted: step("for_each", ["program", "body", "D"], { variable: "colour", items: ["red"], index: "number" }),
    inCounted: step("wait", ["counted", "body", "A"]),
    inner: step("operate", ["loop", "body", "A"]),
    call: step("call", ["program", "body", "C"], { function: "mix", result: "total" }),
    local: step("set", ["mix", "body", "A"], { variable: "count", value: { quantity: [3, "MIN"] } }),
    guard: step("try", ["loop", "body", "B"]),
    tried: step("move", ["guard", "body", "A"]),
    told: step("notify", ["guard", "catch", "A"]),
    draft: step("set", null, { variable: "lost", value: 1 }),
  },
};

test("inside a loop its variable comes first, then what the program sets and takes", () => {
  expect(knownNames(DOCUMENT, "inner")).toEqual([
    { name: "mixer", type: "device" },
    { name: "dry", type: "text" },
    { name: "total", type: "number" },
    { name: "boxes", type: "number" },
  ]);
});

test("a loop that counts its rounds has a number, too", () => {
  expect(knownNames(DOCUMENT, "inCounted").slice(0, 2)).toEqual([
    { name: "number", type: "number" },
    { name: "colour", type: "text" },
  ]);
  expect(freshName(DOCUMENT, "number")).toBe("number2");
});

test("what is set to a list is one, and the item of a loop over it is what stands in it", () => {
  const longer = { op: "+", args: [{ op: "list", args: [] }, ["red"]] };
  const steps = {
    set: step("set", ["program", "body", "A"], { variable: "colours", value: ["red", "blue"] }),
    more: step("set", ["program", "body", "B"], { variable: "more", value: longer }),
    loop: step("for_each", ["program", "body", "C"], { variable: "colour", list: { param: "colours" } }),
    inner: step("wait", ["loop", "body", "A"]),
  };
  expect(knownNames({ ...EMPTY_DOCUMENT, steps }, "inner")).toEqual([
    { name: "colour", type: "text" },
    { name: "colours", type: "list" },
    { name: "more", type: "list" },
  ]);
});

test("inside a function its parameters and its own names come before the program's", () => {
  expect(knownNames(DOCUMENT, "local").map((each) => each.name)).toEqual(["minutes", "count", "dry", "total", "boxes"]);
  expect(namesSet(DOCUMENT, "mix")).toEqual([{ name: "count", type: "number", unit: "MIN" }]);
});

test("a catch knows the text and the kind of the failure, the body does not", () => {
  expect(knownNames(DOCUMENT, "told").slice(0, 3)).toEqual([
    { name: "problem.text", type: "text" },
    { name: "problem.kind", type: "text" },
    { name: "mixer", type: "device" },
  ]);
  expect(knownNames(DOCUMENT, "tried")[0]?.name).toBe("mixer");
});

test("what only a draft sets is not known", () => {
  expect(namesSet(DOCUMENT, null).map((each) => each.name)).toEqual(["dry", "total"]);
});

test("a fresh name is one that nothing has", () => {
  expect([freshName(DOCUMENT, "item"), freshName(DOCUMENT, "mixer")]).toEqual(["item", "mixer2"]);
});

test("a name is written as the script can have it", () => {
  expect([asName(" red boxes "), asName("2nd"), asName("größe!")]).toEqual(["red_boxes", "_2nd", "größe"]);
});

test("a step in a further catch knows the problem", () => {
  const steps = {
    head: step("try", ["program", "body", "A"], { kinds: ["failed"], kinds2: [] }),
    tell: step("notify", ["head", "catch2", "A"]),
    work: step("wait", ["head", "body", "A"]),
  };
  const document = { ...EMPTY_DOCUMENT, steps };
  const problem = (id: string) => knownNames(document, id).some(({ name }) => name === "problem.kind");
  expect([problem("tell"), problem("work")]).toEqual([true, false]);
});

test("a fresh name is no parameter of a function either", () => {
  const functions = { f: { name: "f", parameters: [{ name: "item", type: "number" }] } };
  expect(freshName({ ...EMPTY_DOCUMENT, functions }, "item")).toBe("item2");
});
