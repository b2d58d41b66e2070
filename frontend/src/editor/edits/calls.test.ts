import { expect, test } from "vitest";
import { expandCall, wrapInFunction } from "./calls";
import { clip, clippingFromText, clippingToText, paste } from "./clipping";
import { applyEdits, type Decision } from "./edits";
import { endOfBranch } from "./joints";
import { PROGRAM, readTree } from "@/program/document/tree";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";

function step(kind: string, place: Step["place"], params: Step["params"] = {}): Step {
  return { kind, place, pos: [1, -1], params };
}

const number = { param: "minutes" };

/** 1 wait, 2 mix(minutes: 3, oven: Oven 1) */
const program: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  roles: { carrier: { name: "carrier", can: ["pick"] } },
  functions: {
    mix: {
      name: "mix",
      parameters: [
        { name: "minutes", type: "number", default: 7 },
        { name: "oven", type: "device" },
      ],
    },
  },
  steps: {
    first: step("wait", ["program", "body", "A"]),
    call: step("call", ["program", "body", "B"], {
      function: "mix",
      args: { minutes: { op: "+", args: [1, 2] }, oven: { device: "oven1" } },
      result: "total",
    }),
    loop: step("while", ["mix", "body", "A"], {
      condition: { op: "<", args: [{ property: [{ param: "oven" }, "temperature"] }, number] },
    }),
    go: step("move", ["loop", "body", "A"], { role: "carrier", to: { param: "oven" } }),
    out: step("return", ["mix", "body", "B"], { value: number }),
  },
};

function counter(): () => string {
  let count = 0;
  return () => `new${(count += 1)}`;
}

function after(decision: Decision, before = program): ProgramDocument {
  if ("refused" in decision) throw new Error(decision.refused);
  return applyEdits(before, decision.edits);
}

const kinds = (document: ProgramDocument, parent: string) =>
  readTree(document)
    .children(parent, "body")
    .map((id) => document.steps[id]?.kind);

test("the last call of a function gives way to its steps, with arguments for parameters", () => {
  const expanded = after(expandCall(program, "call", counter()));
  expect(kinds(expanded, "program")).toEqual(["wait", "while", "set"]);
  expect(expanded.functions).toEqual({});
  const [, loop = "", set = ""] = readTree(expanded).children("program", "body");
  const sum = { op: "+", args: [1, 2] };
  expect(expanded.steps[loop]?.params.condition).toEqual({
    op: "<",
    args: [{ property: ["oven1", "temperature"] }, sum],
  });
  expect(expanded.steps[set]?.params).toEqual({ variable: "total", value: sum });
  const [go = ""] = readTree(expanded).children(loop, "body");
  expect(expanded.steps[go]?.params.to).toEqual({ device: "oven1" });
  expect(Object.keys(expanded.steps)).toHaveLength(4);
});

test("while others call it the function stays as it is", () => {
  const twice = { ...program, steps: { ...program.steps, other: step("call", null, { function: "mix", args: {} }) } };
  const expanded = after(expandCall(twice, "call", counter()), twice);
  expect(kinds(expanded, "mix")).toEqual(["while", "return"]);
  expect(kinds(expanded, "program")).toEqual(["wait", "while", "set"]);
});

test("a parameter that the body sets keeps its name and begins with the argument", () => {
  const set = step("set", ["mix", "body", "0"], { variable: "minutes", value: { op: "+", args: [number, 1] } });
  const counting = { ...program, steps: { ...program.steps, set } };
  const expanded = after(expandCall(counting, "call", counter()), counting);
  const ids = readTree(expanded).children("program", "body");
  expect(ids.map((id) => expanded.steps[id]?.kind)).toEqual(["wait", "set", "set", "while", "set"]);
  expect(expanded.steps[ids[1] ?? ""]?.params).toEqual({ variable: "minutes", value: { op: "+", args: [1, 2] } });
  expect(expanded.steps[ids[4] ?? ""]?.params.value).toEqual(number);
});

test("a function that is left early is not expanded", () => {
  const early = { ...program, steps: { ...program.steps, early: step("return", ["loop", "body", "B"]) } };
  expect(expandCall(early, "call", counter())).toEqual({ refused: "returns" });
  expect(expandCall(program, "first", counter())).toEqual({ refused: "nothing" });
});

test("making a function and expanding it again gives the same order", () => {
  const wrapped = after(wrapInFunction(program, ["first", "call"], { functionId: "f", callId: "c", name: "both" }));
  expect(kinds(wrapped, "program")).toEqual(["call"]);
  expect(kinds(after(expandCall(wrapped, "c", counter()), wrapped), "program")).toEqual(["wait", "call"]);
});

test("a clipping travels as text with its functions and roles into another program", () => {
  const text = clippingToText(clip(program, ["call"]));
  const clipping = clippingFromText(text);
  if (!clipping) throw new Error("not read");
  const { edits, added } = paste(EMPTY_DOCUMENT, clipping, endOfBranch(EMPTY_DOCUMENT, PROGRAM), counter());
  const pasted = applyEdits(EMPTY_DOCUMENT, edits);
  expect(readTree(pasted).children("program", "body")).toEqual(added);
  expect(kinds(pasted, "mix")).toEqual(["while", "return"]);
  expect(pasted.roles).toEqual(program.roles);
  expect(readTree(pasted).drafts).toEqual([]);
});

test("other text is no clipping", () => {
  for (const text of [
    "",
    "class Task(object):",
    "{}",
    '{"type":"vipo steps 2"}',
    '{"type":"vipo steps 2","steps":{"a":1}}',
  ])
    expect(clippingFromText(text)).toBeNull();
});

test("a fresh call stands under all of its steps and covers none", () => {
  const at = (key: string, y: number): Step => ({ ...step("wait", ["program", "body", key]), pos: [2, y] });
  const document = { ...EMPTY_DOCUMENT, steps: { a: at("A", -1), b: at("B", -2.6) } };
  const decision = wrapInFunction(document, ["a", "b"], { functionId: "f", callId: "c", name: "both" });
  expect("edits" in decision && applyEdits(document, decision.edits).steps.c?.pos).toEqual([2, -3.5]);
});
