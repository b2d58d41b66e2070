import { expect, test } from "vitest";
import type { ConstructChange, ValueChange } from "@/api/types";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { surroundingsOf } from "@/program/surroundings";
import compareEnglish from "@/i18n/en/screens/compare.json";
import { STEP_KINDS } from "@/program/kinds";
import { fieldLines, otherName } from "./fieldWords";
import { reversed } from "./useRestore";

const WAIT: Step = { kind: "wait", place: ["program", "body", "A"], pos: [0, 0], params: { duration: 60 } };
const CALL: Step = { kind: "call", place: ["w", "body", "A"], pos: [0, 0], params: { function: "f" } };
const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: { a: WAIT, c: CALL },
  functions: { f: { name: "mixPaint", parameters: [] } },
  zones: { z: { name: "Gate", rule: "keep_out", points: [] } },
};
const say = (key: string, values?: Record<string, unknown>) =>
  values && "defaultValue" in values
    ? key.endsWith("duration")
      ? "time"
      : ""
    : [key, ...Object.values(values ?? {})].join(" ");
const side = (numbers: Record<string, string>) => ({
  numbers,
  speaker: { document: DOCUMENT, surroundings: surroundingsOf([], []), t: (key: string) => key },
});
const lines = (id: string, root: ConstructChange["root"], ...changes: ValueChange[]) =>
  fieldLines(
    { root, id, kind: "changed", moved: false, changes },
    side({ a: "1", c: "2a", w: "2" }),
    side({ a: "3", c: "2a", w: "2" }),
    say,
  ).map((line) => [line.label, line.old, line.new]);

test("a field has its name and both values in words", () => {
  expect(lines("a", "steps", { path: ["steps", "a", "params", "duration"], old: 60, new: 120 })).toEqual([
    ["time", "1\u202fmin", "2\u202fmin"],
  ]);
  expect(lines("c", "steps", { path: ["steps", "c", "params", "function"], old: "f", new: "gone" })).toEqual([
    ["function", "mixPaint", "gone"],
  ]);
});

test("an argument has its own name, and what nothing stood in has nothing", () => {
  expect(lines("c", "steps", { path: ["steps", "c", "params", "args", "minutes"], new: 3 })).toEqual([
    ["minutes", null, "3"],
  ]);
  expect(lines("c", "steps", { path: ["steps", "c", "params", "result"], old: null, new: true })).toEqual([
    ["result", "compare.none", "compare.yes"],
  ]);
});

test("a place is told by the number that it has on each side, and by what it stands in", () => {
  expect(
    lines("a", "steps", { path: ["steps", "a", "place"], old: ["program", "body", "A"], new: ["w", "body", "B"] }),
  ).toEqual([["place", "1", "compare.place_inside 3 2"]]);
  expect(
    lines("b", "steps", { path: ["steps", "b", "place"], old: null, new: ["program", "body", "B"] }).map(
      ([, ...sides]) => sides,
    ),
  ).toEqual([["compare.none", "compare.joined_to_nothing"]]);
});

test("values without words are shown as they are written, lists by their parts", () => {
  expect(lines("z", "zones", { path: ["zones", "z", "points"], old: [[1, 2]], new: [] })).toEqual([
    ["points", "compare.parts 1", "compare.none"],
  ]);
  expect(lines("r", "roles", { path: ["roles", "r", "can"], old: ["pick", "drop"], new: { odd: 1 } })).toEqual([
    ["can", "pick, drop", '{"odd":1}'],
  ]);
});

test("a construct that is no step is called by its name, in whichever document it has one", () => {
  expect(otherName({ root: "functions", id: "f" }, [EMPTY_DOCUMENT, DOCUMENT])).toBe("mixPaint");
  expect(otherName({ root: "zones", id: "gone" }, [DOCUMENT])).toBe("gone");
});

test("what takes a change back has old and new exchanged, and leaves out what was not there", () => {
  expect(
    reversed([
      { path: ["steps", "a"], new: 1 },
      { path: ["steps", "b"], old: 1 },
      { path: ["steps", "c"], old: null, new: 2 },
    ]),
  ).toEqual([
    { path: ["steps", "a"], old: 1 },
    { path: ["steps", "b"], new: 1 },
    { path: ["steps", "c"], old: 2, new: null },
  ]);
});

test("every field of every kind of step has a name", () => {
  const fields = STEP_KINDS.flatMap((kind) => kind.forms.flatMap((form) => form.fields ?? []));
  const names = new Set(fields.map((field) => field.name));
  expect([...names].filter((name) => !(name in compareEnglish.field))).toEqual([]);
});
