import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { takeApart } from "../edits/branches";
import { expandCall } from "../edits/calls";
import { applyEdits, type Decision, type Edit } from "../edits/edits";
import { deleteSteps } from "../edits/joints";
import { copiesOf, keptOf, putBack } from "./keptSteps";

const step = (kind: string, parent: string, duration?: number): Step => {
  return { kind, pos: [1, -1], place: [parent, "body", "a"], params: duration === undefined ? {} : { duration } };
};
const BEFORE: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: { loop: step("while", "program"), inner: step("while", "loop"), wait: step("wait", "inner", 5) },
};

function editsOf(decision: Decision): readonly Edit[] {
  if ("refused" in decision) throw new Error(decision.refused);
  return decision.edits;
}

/** The program after somebody's removal, and what is kept of the loop. */
function removed(edits: readonly Edit[]) {
  const now = applyEdits(BEFORE, edits);
  const gone = Object.keys(BEFORE.steps).filter((id) => !Object.hasOwn(now.steps, id));
  return { now, kept: keptOf(BEFORE, "loop", gone) };
}

test("a loop that was removed with all in it comes back with all in it", () => {
  const { now, kept } = removed(deleteSteps(BEFORE, ["loop"]));
  expect(now.steps).toEqual({});
  expect(applyEdits(now, putBack(now, kept)).steps).toEqual(BEFORE.steps);
});

test("a loop that was taken apart comes back without what stood in it and is worked on elsewhere", () => {
  const { now, kept } = removed(editsOf(takeApart(BEFORE, "loop")));
  const later = applyEdits(now, [{ do: "set_param", id: "wait", name: "duration", value: 600 }]);
  const back = applyEdits(later, putBack(later, kept)).steps;
  expect(back).toEqual({ ...later.steps, loop: BEFORE.steps.loop });
  expect(back.inner?.place?.[0]).toBe("program");
});

test("what was taken out of a loop before the loop went, and deleted later, does not come back with it", () => {
  const { now, kept } = removed(editsOf(takeApart(BEFORE, "loop")));
  const later = applyEdits(now, deleteSteps(now, ["inner"]));
  expect(Object.keys(applyEdits(later, putBack(later, kept)).steps)).toEqual(["loop"]);
});

test("what somebody has brought back since stays as it is", () => {
  const { now, kept } = removed(deleteSteps(BEFORE, ["loop"]));
  const later = applyEdits(now, [{ do: "add_step", id: "wait", step: step("wait", "program", 600) }]);
  expect(applyEdits(later, putBack(later, kept)).steps).toEqual({ ...BEFORE.steps, wait: later.steps.wait });
});

test("the steps of a function whose last call was expanded go on under other names", () => {
  const mixing: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    functions: { mix: { name: "mix", parameters: [] } },
    steps: {
      call: { ...step("call", "program"), params: { function: "mix" } },
      loop: step("while", "mix"),
      wait: { ...step("wait", "loop", 5), pos: [2, -2] },
      other: { ...step("wait", "loop", 6), pos: [2, -3] },
    },
  };
  let count = 0;
  const now = applyEdits(mixing, editsOf(expandCall(mixing, "call", () => `new${(count += 1)}`)));
  const copies = copiesOf(mixing, Object.keys(mixing.steps), now.steps);
  const found = (id: string) => now.steps[copies.get(id) ?? ""]?.params.duration;
  expect(["wait", "other", "call"].map(found)).toEqual([5, 6, undefined]);
  expect(copies.size).toBe(3);
});

test("what comes to the spot of a step that was removed is no copy of it, but where its function was expanded", () => {
  const [at, there] = [step("wait", "program"), step("wait", "mix")];
  const calls: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    functions: { mix: { name: "mix", parameters: [] } },
    steps: { call: { ...step("call", "program"), params: { function: "mix" } }, at, there, too: there },
  };
  const found = (...gone: string[]) => [...copiesOf(calls, gone, { copy: at })];
  expect(found("at")).toEqual([]);
  expect(found("there")).toEqual([]);
  expect(found("call", "at")).toEqual([]);
  expect(found("call", "there", "too")).toEqual([["there", "copy"]]);
});
