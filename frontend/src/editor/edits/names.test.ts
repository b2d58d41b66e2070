import { expect, test } from "vitest";
import { applyEdits } from "./edits";
import { changeParameter, changeProgramParameter } from "./names";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";

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
