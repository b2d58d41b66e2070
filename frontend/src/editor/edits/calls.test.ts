import { expect, test } from "vitest";
import { expandCall, wrapInFunction } from "./calls";
import { clip, clippingFromText, clippingToText, paste } from "./clipping";
import { applyEdits, type Decision } from "./edits";
import { endOfBranch } from "./joints";
import { PROGRAM, readTree } from "@/program/document/tree";
import { EMPTY_DOCUMENT, type Parameter, type ProgramDocument, type Step } from "@/program/document/document";

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
  expect(kinds(expanded, "program")).toEqual(["wait", "set", "while", "set"]);
  expect(expanded.functions).toEqual({});
  const [, first = "", loop = "", set = ""] = readTree(expanded).children("program", "body");
  expect(expanded.steps[first]?.params).toEqual({ variable: "minutes", value: { op: "+", args: [1, 2] } });
  expect(expanded.steps[loop]?.params.condition).toEqual({
    op: "<",
    args: [{ property: ["oven1", "temperature"] }, number],
  });
  expect(expanded.steps[set]?.params).toEqual({ variable: "total", value: number });
  const [go = ""] = readTree(expanded).children(loop, "body");
  expect(expanded.steps[go]?.params.to).toEqual({ device: "oven1" });
  expect(Object.keys(expanded.steps)).toHaveLength(5);
});

test("while others call it the function stays as it is, and its names too", () => {
  const twice = { ...program, steps: { ...program.steps, other: step("call", null, { function: "mix", args: {} }) } };
  const expanded = after(expandCall(twice, "call", counter()), twice);
  expect(kinds(expanded, "mix")).toEqual(["while", "return"]);
  expect(kinds(expanded, "program")).toEqual(["wait", "set", "while", "set"]);
  const [, first = ""] = readTree(expanded).children("program", "body");
  expect(expanded.steps[first]?.params.variable).toBe("minutes2");
});

/** What a call of a function with one parameter `goal` becomes: the parameters of its steps in their order. */
function expandedAs(
  goal: unknown,
  body: ProgramDocument["steps"],
  more: Partial<ProgramDocument> = {},
  parameter: Partial<Parameter> = {},
): unknown {
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    ...more,
    functions: { ...more.functions, f: { name: "f", parameters: [{ name: "goal", type: "number", ...parameter }] } },
    steps: {
      call: step("call", ["program", "body", "M"], { function: "f", args: { goal } }),
      ...more.steps,
      ...body,
    },
  };
  const decision = expandCall(document, "call", counter());
  if ("refused" in decision) return decision.refused;
  const added = decision.edits.flatMap((edit) => (edit.do === "add_step" ? [edit.id] : []));
  const expanded = applyEdits(document, decision.edits);
  return readTree(expanded)
    .reading.filter((id) => added.includes(id))
    .map((id) => expanded.steps[id]?.params);
}

const goal = { param: "goal" };
const say = (message: unknown, place: Step["place"] = ["f", "body", "Z"]) => step("notify", place, { message });

test("an argument that has to be worked out is worked out once, before the body", () => {
  const heat = { property: ["oven", "temperature"] };
  const warmer = { op: "+", args: [heat, { quantity: [10, "DEG_C"] }] };
  const loop = step("while", ["f", "body", "A"], { condition: { op: "<", args: [heat, goal] } });
  expect(expandedAs(warmer, { loop })).toEqual([
    { variable: "goal", value: warmer },
    { condition: { op: "<", args: [heat, goal] } },
  ]);
  const zero = step("set", ["f", "body", "A"], { variable: "left", value: 0 });
  const rounds = step("repeat", ["f", "body", "B"], { times: goal });
  expect(expandedAs({ param: "left" }, { zero, rounds })).toEqual([
    { variable: "goal", value: { param: "left" } },
    { variable: "left", value: 0 },
    { times: goal },
  ]);
});

test("what is written out stands for its parameter, a bare number in the parameter's unit", () => {
  const wait = step("wait", ["f", "body", "A"], { duration: goal });
  expect(expandedAs(3, { wait })).toEqual([{ duration: 3 }]);
  expect(expandedAs(3, { wait }, {}, { unit: "MIN" })).toEqual([{ duration: { quantity: [3, "MIN"] } }]);
  expect(expandedAs(undefined, { wait }, {}, { unit: "MIN", default: 4 })).toEqual([
    { duration: { quantity: [4, "MIN"] } },
  ]);
  const go = step("move", ["f", "body", "A"], { to: goal });
  for (const device of [{ device: "oven" }, { at: { device: "oven" } }])
    expect(expandedAs(device, { go }, {}, { type: "device" })).toEqual([{ to: { device: "oven" } }]);
  expect(expandedAs(undefined, { go }, {}, { type: "device", default: "oven" })).toEqual([{ to: { device: "oven" } }]);
});

test("names of the function become others where the program has them for something else", () => {
  const parameters = { p: { name: "goal", type: "number", default: 1 } };
  const local = step("set", ["f", "body", "A"], { variable: "sum", value: goal });
  const others = step("set", ["g", "body", "A"], { variable: "sum", value: 1 });
  const functions = { g: { name: "g", parameters: [] } };
  const more = { parameters, functions, steps: { others } };
  expect(expandedAs({ param: "goal" }, { local, said: say({ param: "sum" }) }, more)).toEqual([
    { variable: "goal2", value: { param: "goal" } },
    { variable: "sum2", value: { param: "goal2" } },
    { message: { param: "sum2" } },
  ]);
});

test("in a loop that has the name for itself it stays the loop's", () => {
  const each = step("for_each", ["f", "body", "A"], { variable: "goal", items: [goal] });
  const body = { each, said: say(goal, ["each", "body", "A"]) };
  expect(expandedAs(5, body)).toEqual([{ variable: "goal", items: [5] }, { message: goal }]);
});

test("steps that mean a name of the program are not put where that name means something else", () => {
  const loop = step("for_each", ["program", "body", "A"], { variable: "total", items: [1] });
  const inside = step("call", ["loop", "body", "A"], { function: "f", args: { goal: 1 } });
  expect(expandedAs(1, { said: say({ param: "total" }) }, { steps: { loop, call: inside } })).toBe("hidden");
  expect(expandedAs(1, { said: say(goal) }, { steps: { loop, call: inside } })).toEqual([{ message: 1 }]);
  const functions = { g: { name: "g", parameters: [{ name: "total", type: "number" }] } };
  const call = step("call", ["g", "body", "A"], { function: "f", args: { goal: 1 } });
  const set = step("set", ["f", "body", "A"], { variable: "total", value: 0 });
  const shared = step("set", ["program", "body", "A"], { variable: "total", value: 1 });
  expect(expandedAs(1, { set }, { functions, steps: { call, shared } })).toBe("hidden");
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
