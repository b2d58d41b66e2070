import { expect, test } from "vitest";
import { applyEdits } from "./edits";
import { changeParameter, changeProgramParameter } from "./names";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";

const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  parameters: { p: { name: "count", type: "number" } },
  functions: { mix: { name: "mix", parameters: [{ name: "minutes", type: "number" }] } },
  steps: {
    call: {
      kind: "call",
      place: ["program", "body", "A"],
      params: { function: "mix", args: { minutes: { param: "count" } } },
    },
    wait: { kind: "wait", place: ["mix", "body", "A"], params: { duration: { param: "minutes" } } },
    other: { kind: "wait", place: ["program", "body", "B"], params: { duration: { param: "minutes" } } },
  },
};

test("a renamed parameter takes its readers and its arguments along, and nobody else", () => {
  const next = applyEdits(DOCUMENT, changeParameter(DOCUMENT, "mix", 0, { name: "time", type: "number" }));
  expect(next.functions.mix?.parameters).toEqual([{ name: "time", type: "number" }]);
  expect(next.steps.wait?.params).toEqual({ duration: { param: "time" } });
  expect(next.steps.call?.params.args).toEqual({ time: { param: "count" } });
  expect(next.steps.other).toBe(DOCUMENT.steps.other);
});

test("a renamed parameter of the program is renamed wherever it is read", () => {
  const next = applyEdits(DOCUMENT, changeProgramParameter(DOCUMENT, "p", { name: "boxes", type: "number" }));
  expect(next.parameters).toEqual({ p: { name: "boxes", type: "number" } });
  expect(next.steps.call?.params.args).toEqual({ minutes: { param: "boxes" } });
});

test("another type alone changes nothing else", () => {
  expect(changeParameter(DOCUMENT, "mix", 0, { name: "minutes", type: "text" })).toHaveLength(1);
});

const at = (kind: string, place: Step["place"], params: Step["params"]): Step => ({ kind, place, params });
const count = { param: "count" };
const less = { variable: "count", value: { op: "-", args: [count, 1] } };
/** While count > 0 in a parent: count = count - 1; count = ask; count = mix(); for count of count: notify count. */
const counting = (parent: string): ProgramDocument["steps"] => ({
  loop: at("while", [parent, "body", "A"], { condition: { op: ">", args: [count, 0] } }),
  less: at("set", ["loop", "body", "A"], less),
  ask: at("ask", ["loop", "body", "B"], { question: "How many?", answer: { type: "number" }, variable: "count" }),
  given: at("call", ["loop", "body", "C"], { function: "other", args: {}, result: "count" }),
  each: at("for_each", [parent, "body", "B"], { variable: "count", list: count }),
  said: at("notify", ["each", "body", "A"], { message: count }),
  own: at("set", ["each", "body", "B"], less),
});

test.each(["mix", "program"])("what sets a renamed parameter of %s goes along, what belongs to a loop stays", (top) => {
  const document = { ...DOCUMENT, steps: counting(top) };
  const parameters = [{ name: "count", type: "number" }];
  const next = { name: "rounds", type: "number" };
  const edits =
    top === "mix"
      ? changeParameter({ ...document, functions: { mix: { name: "mix", parameters } } }, "mix", 0, next)
      : changeProgramParameter(document, "p", next);
  const { loop, less: set, ask, given, each, said, own } = applyEdits(document, edits).steps;
  const rounds = { param: "rounds" };
  expect(loop?.params.condition).toEqual({ op: ">", args: [rounds, 0] });
  expect(set?.params).toEqual({ variable: "rounds", value: { op: "-", args: [rounds, 1] } });
  expect([ask?.params.variable, given?.params.result]).toEqual(["rounds", "rounds"]);
  expect(each?.params).toEqual({ variable: "count", list: rounds });
  expect([said, own]).toEqual([document.steps.said, document.steps.own]);
});

test("a function sets the program's parameter where the program does, too, and else a variable of its own", () => {
  const inside = at("set", ["mix", "body", "B"], less);
  const renamed = (steps: ProgramDocument["steps"]) => {
    const document = { ...DOCUMENT, steps: { ...steps, inside } };
    const edits = changeProgramParameter(document, "p", { name: "rounds", type: "number" });
    return applyEdits(document, edits).steps.inside?.params.variable;
  };
  expect(renamed({ outside: at("set", ["program", "body", "A"], less) })).toBe("rounds");
  expect(renamed({})).toBe("count");
});
