import { expect, test } from "vitest";
import { applyEdits, type Decision } from "./edits";
import {
  addStep,
  branchForNew,
  clip,
  deleteSteps,
  joinSteps,
  moveStep,
  paste,
  shiftStep,
  wrapInFunction,
} from "./gestures";
import { PROGRAM, readTree } from "./tree";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step, type StepKind } from "./types";

function step(kind: StepKind, place: Step["place"], params: Step["params"] = {}): Step {
  return { kind, place, pos: [1, -1], params };
}

/** 1 move, 2 while (2a wait, 2b wait), 3 drop */
const program: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: {
    one: step("move", ["program", "body", "A"]),
    loop: step("while", ["program", "body", "B"]),
    in1: step("wait", ["loop", "body", "A"]),
    in2: step("wait", ["loop", "body", "B"]),
    three: step("drop", ["program", "body", "C"]),
  },
};

function after(decision: Decision): ProgramDocument {
  if ("refused" in decision) throw new Error(decision.refused);
  return applyEdits(program, decision.edits);
}

const body = (document: ProgramDocument) => readTree(document).children("program", "body");
const loop = (document: ProgramDocument) => readTree(document).children("loop", "body");

test("a new step follows the last one of its branch", () => {
  const fresh = { id: "new", kind: "wait", pos: [0, 0], params: {} } as const;
  expect(body(applyEdits(program, addStep(program, PROGRAM, fresh)))).toEqual(["one", "loop", "three", "new"]);
  const inside = addStep(program, branchForNew(program, "in1"), fresh);
  expect(loop(applyEdits(program, inside))).toEqual(["in1", "in2", "new"]);
});

test("a step is inserted in between and moved into another branch", () => {
  expect(body(after(moveStep(program, "three", PROGRAM, "one")))).toEqual(["one", "three", "loop"]);
  expect(body(after(moveStep(program, "three", PROGRAM, null)))).toEqual(["three", "one", "loop"]);
  expect(loop(after(moveStep(program, "three", { parent: "loop", branch: "body" }, "in1")))).toEqual([
    "in1",
    "three",
    "in2",
  ]);
});

test("a step cannot go into itself", () => {
  expect(moveStep(program, "loop", { parent: "loop", branch: "body" }, null)).toEqual({ refused: "cycle" });
  expect(joinSteps(program, "in1", "loop")).toEqual({ refused: "cycle" });
});

test("joining puts the target behind the step whose dot was dragged", () => {
  expect(body(after(joinSteps(program, "three", "one")))).toEqual(["loop", "three", "one"]);
});

test("deleting a frame deletes what stands in it and joins its neighbours", () => {
  const rest = applyEdits(program, deleteSteps(program, ["loop"]));
  expect(Object.keys(rest.steps).sort()).toEqual(["one", "three"]);
  expect(body(rest)).toEqual(["one", "three"]);
});

test("a step changes places with its neighbour, not beyond the end", () => {
  expect(body(after(shiftStep(program, "three", -1)))).toEqual(["one", "three", "loop"]);
  expect(body(after(shiftStep(program, "one", 1)))).toEqual(["loop", "one", "three"]);
  expect(shiftStep(program, "three", 1)).toEqual({ refused: "nothing" });
});

test("neighbours become a function that is called where they stood", () => {
  const fresh = { functionId: "f", callId: "call", name: "tidyUp" };
  const wrapped = after(wrapInFunction(program, ["one", "loop", "in1"], fresh));
  expect(body(wrapped)).toEqual(["call", "three"]);
  expect(readTree(wrapped).children("f", "body")).toEqual(["one", "loop"]);
  expect(loop(wrapped)).toEqual(["in1", "in2"]);
  expect(wrapped.functions.f?.name).toBe("tidyUp");
});

test("steps that are not neighbours do not become a function", () => {
  const fresh = { functionId: "f", callId: "call", name: "tidyUp" };
  expect(wrapInFunction(program, ["one", "three"], fresh)).toEqual({ refused: "one_branch" });
  expect(wrapInFunction(program, ["one", "in1"], fresh)).toEqual({ refused: "one_branch" });
});

test("a pasted frame keeps its inside and its order under new ids", () => {
  let count = 0;
  const { edits, added } = paste(program, clip(program, ["three", "loop"]), PROGRAM, () => `copy${(count += 1)}`);
  const pasted = applyEdits(program, edits);
  expect(body(pasted)).toEqual(["one", "loop", "three", ...added]);
  expect(added.map((id) => pasted.steps[id]?.kind)).toEqual(["while", "drop"]);
  expect(readTree(pasted).children(added[0] ?? "", "body")).toHaveLength(2);
});

test("a step without a place is a draft, and of a circle the step with the smallest id", () => {
  const broken = {
    ...program,
    steps: {
      ...program.steps,
      loose: step("wait", null),
      a: step("while", ["b", "body", "A"]),
      b: step("while", ["a", "body", "A"]),
    },
  };
  expect(readTree(broken).drafts).toEqual(["a", "loose"]);
  expect(readTree(broken).loose).toEqual(["a", "b", "loose"]);
});
