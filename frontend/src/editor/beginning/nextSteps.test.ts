/** What is offered after a step: only what the machine there can do, and only at the end of its branch. */
import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step, textOf } from "@/program/document/document";
import { surroundingsOf } from "@/program/surroundings";
import { exampleSite } from "./exampleSite";
import { type NextStep, nextSteps } from "./nextSteps";

const { devices, places } = exampleSite();
const surroundings = surroundingsOf(devices, places);

function task(order: string, source: string, target: string, object: string): Step {
  const params = { role: "robot", source: { device: source }, target: { device: target }, object, quantity: 2 };
  return { kind: "pick_and_drop", place: ["program", "body", order], pos: [1, -1], params };
}

const fetched: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: { a: task("A", "itemInventory01", "paintMachine01", "box") },
};
const painted: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: {
    ...fetched.steps,
    b: {
      kind: "operate",
      place: ["program", "body", "B"],
      pos: [1, -1],
      params: { device: { device: "paintMachine01" }, method: "paint", args: { time: 2 } },
    },
  },
};

function said(document: ProgramDocument, id: string): string[] {
  return nextSteps({ document, surroundings }, id).map((next: NextStep) =>
    next.do === "operate"
      ? `operate ${next.method.name}`
      : next.do === "carry"
        ? `carry ${textOf(next.load.quantity)} ${textOf(next.load.object)} to ${next.to.name}`
        : `drive to ${next.to.name}`,
  );
}

test("after something is brought to a machine, its work is offered, then to carry on what was brought", () => {
  expect(said(fetched, "a")).toEqual([
    "operate paint",
    "carry 2 box to Curing Oven",
    "carry 2 box to Drop-off",
    "drive to Dock 3",
  ]);
});

test("after the machine's work only what comes behind it is offered", () => {
  expect(said(painted, "b")).toEqual(["carry 2 box to Curing Oven", "carry 2 box to Drop-off", "drive to Dock 3"]);
});

test("a machine that the program has used already comes after those that it has not", () => {
  const steps = { ...painted.steps, c: task("C", "curingOven01", "dropOff01", "box") };
  const moved = { ...steps, b: { ...painted.steps.b, place: ["program", "body", "D"] } as Step };
  expect(said({ ...EMPTY_DOCUMENT, steps: moved }, "b").slice(0, 2)).toEqual([
    "carry 2 box to Curing Oven",
    "carry 2 box to Drop-off",
  ]);
});

test("nothing is offered behind a step that has one behind it, nor where no machine is", () => {
  expect(said(painted, "a")).toEqual([]);
  const wait: Step = { kind: "wait", place: ["program", "body", "A"], pos: [1, -1], params: { duration: 5 } };
  expect(said({ ...EMPTY_DOCUMENT, steps: { w: wait } }, "w")).toEqual([]);
});
