/** Every spot of the order is reached by keys, in reading order, with hard ends. */
import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step, type StepKind } from "@/program/document/document";
import { readTree } from "@/program/document/tree";
import { applyEdits } from "../edits/edits";
import { decideJoin } from "../gestures/connection";
import { beside, decideMove, ownSpot, type Spot, spotsFor } from "./goals";

function step(kind: StepKind, place: Step["place"]): Step {
  return { kind, place, pos: [1, -1], params: kind === "try" ? { kinds: ["failed"] } : {} };
}

/** 1 move, 2 if (true: 2a wait; false: nothing), 3 notify */
const program: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: {
    one: step("move", ["program", "body", "A"]),
    two: step("if", ["program", "body", "B"]),
    wait: step("wait", ["two", "then", "A"]),
    three: step("notify", ["program", "body", "C"]),
    note: step("comment", null),
    event: step("on_event", ["program", "events", "A"]),
  },
};
const said = ({ side, beside: id, branch }: Spot) => `${side} ${id} (${branch.parent}/${branch.branch})`;

test("spots are read from top to bottom, branches between the step that has them and what comes after it", () => {
  expect(spotsFor(program, ["three"]).map(said)).toEqual([
    "before one (program/body)",
    "after one (program/body)",
    "before wait (two/then)",
    "after wait (two/then)",
    "inside two (two/else)",
    "after two (program/body)",
    "inside event (event/body)",
  ]);
});

test("a step never goes into itself, nor an event among steps", () => {
  expect(spotsFor(program, ["two"]).map(said)).toEqual([
    "before one (program/body)",
    "after one (program/body)",
    "after three (program/body)",
    "inside event (event/body)",
  ]);
  expect(spotsFor(program, ["event"]).map(said)).toEqual(["first  (program/events)"]);
  expect(spotsFor(program, ["note"])).toEqual([]);
});

test("the mode begins where the step stands", () => {
  for (const [id, expected] of [
    ["one", "before two (program/body)"],
    ["three", "after two (program/body)"],
    ["wait", "inside two (two/then)"],
  ] as const) {
    const spots = spotsFor(program, [id]);
    expect(said(spots[ownSpot(program, [id], spots)] as Spot)).toBe(expected);
  }
});

test("Enter puts the step where the words say", () => {
  const spots = spotsFor(program, ["three"]);
  const inside = spots.find(({ side }) => side === "inside") as Spot;
  const decision = decideMove(program, ["three"], inside);
  if (!("edits" in decision)) throw new Error("refused");
  const after = readTree(applyEdits(program, decision.edits));
  expect(after.children("two", "else")).toEqual(["three"]);
  expect(after.children("program", "body")).toEqual(["one", "two"]);
});

test("a list has hard ends", () => {
  expect([beside(0, -1, 3), beside(2, 1, 3), beside(1, 1, 3), beside(1, Infinity, 3), beside(1, -Infinity, 3)]).toEqual(
    [0, 2, 2, 2, 0],
  );
});

test("however many spots there are, the program is read once for them", () => {
  let count = 0;
  const functions = new Proxy({}, { ownKeys: () => ((count += 1), []) });
  const ids = Array.from({ length: 40 }, (_, at) => `step${at + 10}`);
  const steps = Object.fromEntries(ids.map((id) => [id, step("wait", ["program", "body", id])]));
  const many = { ...EMPTY_DOCUMENT, functions, steps };
  readTree({ ...many });
  const once = count;
  const spots = spotsFor(many, ["step10"]);
  expect(spots).toHaveLength(40);
  expect(ownSpot(many, ["step10"], spots)).toBe(0);
  for (const id of ids) decideJoin(many, "step10", id);
  expect(count).toBe(2 * once + 1); // and once for the functions' own spots
});
