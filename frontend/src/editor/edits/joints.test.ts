import { expect, test } from "vitest";
import { applyEdits, type Decision } from "./edits";
import { wrapInFunction } from "./calls";
import { clip, paste } from "./clipping";
import {
  addStep,
  branchForNew,
  deleteSteps,
  disconnect,
  endOfBranch,
  joinDrafts,
  joinSteps,
  moveStep,
  moveSteps,
  shiftStep,
} from "./joints";
import { PROGRAM, readTree } from "@/program/document/tree";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step, type StepKind } from "@/program/document/document";

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
  const { edits, added } = paste(
    program,
    clip(program, ["three", "loop"]),
    endOfBranch(program, PROGRAM),
    () => `copy${(count += 1)}`,
  );
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

test("a step goes between two that people appended at the same time", () => {
  const tied = {
    ...program,
    steps: {
      ...program.steps,
      twin: step("wait", ["program", "body", "C"]),
      four: step("wait", ["program", "body", "D"]),
    },
  };
  const decision = moveStep(tied, "one", PROGRAM, "three");
  if ("refused" in decision) throw new Error(decision.refused);
  expect(body(applyEdits(tied, decision.edits))).toEqual(["loop", "three", "one", "twin", "four"]);
  expect(decision.edits.map((edit) => "id" in edit && edit.id)).toEqual(["twin", "one"]);
});

test("several steps move together and keep their order", () => {
  const decision = moveSteps(program, ["one", "three"], { branch: { parent: "loop", branch: "body" }, after: "in1" });
  expect(loop(after(decision))).toEqual(["in1", "one", "three", "in2"]);
});

test("a disconnected step is a draft with all inside it, and joins the end again", () => {
  const apart = after(disconnect(program, ["loop", "in1"]));
  expect([body(apart), readTree(apart).drafts, loop(apart)]).toEqual([["one", "three"], ["loop"], ["in1", "in2"]]);
  const again = joinDrafts(apart, ["loop"]);
  if ("refused" in again) throw new Error(again.refused);
  expect(body(applyEdits(apart, again.edits))).toEqual(["one", "three", "loop"]);
});

test("a draft joined to a step comes before it; two drafts cannot be joined", () => {
  const loose = { ...program, steps: { ...program.steps, x: step("wait", null), y: step("wait", null) } };
  const before = joinSteps(loose, "x", "three");
  if ("refused" in before) throw new Error(before.refused);
  expect(body(applyEdits(loose, before.edits))).toEqual(["one", "loop", "x", "three"]);
  const behind = joinSteps(loose, "in1", "y");
  if ("refused" in behind) throw new Error(behind.refused);
  expect(loop(applyEdits(loose, behind.edits))).toEqual(["in1", "y", "in2"]);
  expect(joinSteps(loose, "x", "y")).toEqual({ refused: "drafts" });
});

test("events stand among the events only, comments nowhere", () => {
  const more = {
    ...program,
    steps: { ...program.steps, hot: step("on_event", ["program", "events", "V"]), note: step("comment", null) },
  };
  expect(moveStep(more, "hot", PROGRAM, null)).toEqual({ refused: "event" });
  expect(moveStep(more, "one", { parent: "program", branch: "events" }, null)).toEqual({ refused: "event" });
  expect(moveStep(more, "note", PROGRAM, null)).toEqual({ refused: "nothing" });
  const fresh = { id: "new", kind: "comment", pos: [0, 0], params: {} } as const;
  expect(applyEdits(more, addStep(more, PROGRAM, fresh)).steps.new?.place).toBeNull();
});

test("steps go nowhere where somebody has taken away the step that they were to follow, or what they were to go into", () => {
  const gone = { refused: "gone" };
  expect(moveStep(program, "three", PROGRAM, "lost")).toEqual(gone);
  expect(moveStep(program, "three", PROGRAM, "in1")).toEqual(gone);
  expect(moveStep(program, "three", { parent: "lost", branch: "body" }, null)).toEqual(gone);
  expect(moveStep(program, "three", { parent: "loop", branch: "else" }, null)).toEqual(gone);
  const functions = { mix: { name: "mix", parameters: [] } };
  expect(moveStep({ ...program, functions }, "three", { parent: "mix", branch: "body" }, null)).toHaveProperty("edits");
});
