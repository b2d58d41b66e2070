import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";
import { STEP_KINDS } from "@/program/kinds";
import { freshParams } from "./newStep";

const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: { s: { kind: "ask", params: { variable: "answer" } } },
};

test("a fresh step knows what its record lets it know", () => {
  expect(freshParams("parallel", DOCUMENT)).toEqual({ branches: ["a", "b"] });
  expect(freshParams("try", DOCUMENT)).toEqual({ kinds: [] });
  expect(freshParams("for_each", EMPTY_DOCUMENT)).toEqual({ variable: "item", items: [] });
  expect(freshParams("ask", EMPTY_DOCUMENT)).toEqual({ answer: { type: "boolean" }, variable: "answer" });
  expect(freshParams("ask", DOCUMENT)?.variable).not.toBe("answer");
  expect(freshParams("notify", DOCUMENT)).toEqual({ level: "info" });
  expect(freshParams("on_event", DOCUMENT)).toEqual({ starts: "branch" });
  expect(freshParams("comment", DOCUMENT)).toEqual({ text: "" });
  expect(freshParams("wait", DOCUMENT)).toEqual({});
});

test("what needs a device, a place or a function is not put on the floor, nor is what is no kind of step", () => {
  const elsewhere = STEP_KINDS.map(({ kind }) => kind).filter((kind) => freshParams(kind, DOCUMENT) === null);
  expect(elsewhere).toEqual(["move", "pick", "drop", "pick_and_drop", "operate", "call"]);
  expect(freshParams("zone", DOCUMENT)).toBeNull();
});
