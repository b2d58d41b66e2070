import { expect, test } from "vitest";
import { applyEdits, type Decision } from "./edits";
import { liftOut, moveIn, swapBranches, takeApart, wrapIn } from "./branches";
import { readTree } from "@/program/document/tree";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";

function step(kind: string, parent: string, branch: string, order: string): Step {
  return { kind, place: [parent, branch, order], pos: [1, -1], params: {} };
}

/** 1 try (body: p, q; catch: c; finally: f), 2 if (then: t; else: e), 3 move; an event with one step */
const program: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: {
    guard: step("try", "program", "body", "A"),
    p: step("wait", "guard", "body", "A"),
    q: step("wait", "guard", "body", "B"),
    c: step("notify", "guard", "catch", "A"),
    f: step("notify", "guard", "finally", "A"),
    choice: step("if", "program", "body", "B"),
    t: step("wait", "choice", "then", "A"),
    e: step("wait", "choice", "else", "A"),
    last: step("move", "program", "body", "C"),
    hot: step("on_event", "program", "events", "A"),
    w: step("wait", "hot", "body", "A"),
  },
};

function after(decision: Decision): ProgramDocument {
  if ("refused" in decision) throw new Error(decision.refused);
  return applyEdits(program, decision.edits);
}

const branch = (document: ProgramDocument, parent: string, name: string) => readTree(document).children(parent, name);

test("steps that are lifted out follow their frame in their order", () => {
  const lifted = after(liftOut(program, ["q", "p"]));
  expect(branch(lifted, "program", "body")).toEqual(["guard", "p", "q", "choice", "last"]);
  expect(branch(lifted, "guard", "body")).toEqual([]);
});

test("nothing is lifted out of the program or out of an event", () => {
  expect(liftOut(program, ["last"])).toEqual({ refused: "not_inside" });
  expect(liftOut(program, ["w"])).toEqual({ refused: "not_inside" });
  expect(liftOut(program, ["p", "t"])).toEqual({ refused: "one_branch" });
});

test("a step moves into the frame before it, with the branch that comes first", () => {
  expect(branch(after(moveIn(program, ["last"])), "choice", "then")).toEqual(["t", "last"]);
  expect(branch(after(moveIn(program, ["choice"])), "guard", "body")).toEqual(["p", "q", "choice"]);
  expect(moveIn(program, ["guard"])).toEqual({ refused: "no_frame" });
  expect(moveIn(program, ["q"])).toEqual({ refused: "no_frame" });
});

test("true and false change their steps", () => {
  const swapped = after(swapBranches(program, "choice"));
  expect([branch(swapped, "choice", "then"), branch(swapped, "choice", "else")]).toEqual([["e"], ["t"]]);
  expect(swapBranches(program, "guard")).toEqual({ refused: "nothing" });
});

test("taken apart, what always ran takes the frame's place and the catch becomes a draft", () => {
  const apart = after(takeApart(program, "guard"));
  expect(branch(apart, "program", "body")).toEqual(["p", "q", "f", "choice", "last"]);
  expect(readTree(apart).drafts).toEqual(["c"]);
  expect(apart.steps.guard).toBeUndefined();
});

test("an If taken apart keeps its true branch; an event's steps become drafts", () => {
  const apart = after(takeApart(program, "choice"));
  expect(branch(apart, "program", "body")).toEqual(["guard", "t", "last"]);
  expect(readTree(apart).drafts).toEqual(["e"]);
  expect(readTree(after(takeApart(program, "hot"))).drafts).toEqual(["w"]);
  expect(takeApart(program, "last")).toEqual({ refused: "nothing" });
});

const limit = { id: "limit", kind: "limit", params: {} } as const;

test("neighbours are put into a new frame that stands where they stood", () => {
  const wrapped = after(wrapIn(program, ["choice", "last"], limit));
  expect(branch(wrapped, "program", "body")).toEqual(["guard", "limit"]);
  expect(branch(wrapped, "limit", "body")).toEqual(["choice", "last"]);
  expect(branch(wrapped, "choice", "then")).toEqual(["t"]);
});

test("one step in a frame gets a frame of its own there", () => {
  const wrapped = after(wrapIn(program, ["q"], limit));
  expect([branch(wrapped, "guard", "body"), branch(wrapped, "limit", "body")]).toEqual([["p", "limit"], ["q"]]);
});

test("the head of the new frame stands above its steps", () => {
  expect(after(wrapIn(program, ["last"], limit)).steps.limit?.pos).toEqual([1, -0.1]);
});

test("what is no row of neighbours, and what begins by itself, gets no frame", () => {
  expect(wrapIn(program, ["guard", "last"], limit)).toEqual({ refused: "one_branch" });
  expect(wrapIn(program, [], limit)).toEqual({ refused: "nothing" });
  expect(wrapIn(program, ["hot"], limit)).toEqual({ refused: "event" });
});

test("a frame around a step is undone by taking it apart", () => {
  const wrapped = after(wrapIn(program, ["p", "q"], limit));
  const apart = takeApart(wrapped, "limit");
  if ("refused" in apart) throw new Error(apart.refused);
  expect(branch(applyEdits(wrapped, apart.edits), "guard", "body")).toEqual(["p", "q"]);
});

test("a step in a further catch is a draft when the Try is taken apart", () => {
  const head = { ...step("try", "program", "body", "A"), params: { kinds: ["failed"], kinds2: [] } };
  const steps = { head, tell: step("notify", "head", "catch2", "A"), work: step("wait", "head", "body", "A") };
  expect(takeApart({ ...EMPTY_DOCUMENT, steps }, "head")).toMatchObject({
    edits: expect.arrayContaining([{ do: "set_place", id: "tell", place: null }]) as unknown,
  });
});
