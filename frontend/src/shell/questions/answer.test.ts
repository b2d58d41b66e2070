import { expect, test } from "vitest";
import type { AnswerSpec } from "@/api/types";
import { readAnswer } from "./answer";

const spec = (more: Partial<AnswerSpec>): AnswerSpec => ({
  type: "number",
  unit: "",
  minimum: null,
  maximum: null,
  options: [],
  ...more,
});

test.each([
  ["", { problem: "number" }],
  ["abc", { problem: "number" }],
  ["2,5", { value: 2.5 }],
  [1, { problem: "low" }],
  [9, { problem: "high" }],
  [5, { value: 5 }],
] as const)("a number %j is read as %j", (typed, read) => {
  expect(readAnswer(spec({ minimum: 2, maximum: 6 }), typed)).toEqual(read);
});

test("a choice must be one of the options, a text may be anything", () => {
  expect(readAnswer(spec({ type: "choice", options: ["red"] }), "blue")).toEqual({ problem: "choose" });
  expect(readAnswer(spec({ type: "choice", options: ["red"] }), "red")).toEqual({ value: "red" });
  expect(readAnswer(spec({ type: "text" }), " fine ")).toEqual({ value: "fine" });
});
