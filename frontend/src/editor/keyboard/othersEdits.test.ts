/** What others change is told in one sentence for each thing that they did. */
import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { sentences, stepsChanged } from "./othersEdits";

const step = (duration: number): Step => ({
  kind: "wait",
  place: ["program", "body", "A"],
  pos: [1, -1],
  params: { duration },
});
const before: ProgramDocument = { ...EMPTY_DOCUMENT, steps: { a: step(1), b: step(2), c: step(3) } };

test("steps that are new, gone and different are told apart from those that were only read anew", () => {
  const after = { ...before, steps: { a: step(1), b: step(5), d: step(4) } };
  expect(stepsChanged(before, after)).toEqual({ added: ["d"], removed: ["c"], changed: ["b"] });
});

test("a step that says the same in another order of its keys is no change", () => {
  const said = (until: unknown): ProgramDocument => ({ ...before, steps: { a: { ...step(1), params: { until } } } });
  expect(stepsChanged(said({ op: ">", args: [1, 2] }), said({ args: [1, 2], op: ">" })).changed).toEqual([]);
});

test("one step is named, several are counted", () => {
  const say = (key: string, values: Record<string, unknown>) =>
    `${String(values.who)} ${key.split(".").at(-1)} ${String(values.count)} ${String(values.step)}`.trim();
  const name = (id: string) => `step ${id}`;
  expect(sentences({ added: ["d"], removed: [], changed: ["a", "b"] }, "Ada", name, say)).toBe(
    "Ada added 1 step d Ada changed 2 step a",
  );
  expect(sentences({ added: [], removed: ["c"], changed: [] }, "Ada", name, say)).toBe("Ada removed 1");
});
