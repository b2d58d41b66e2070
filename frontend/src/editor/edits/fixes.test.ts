import { expect, test } from "vitest";
import { applyEdits } from "./edits";
import { fixEdits, versionOf, inLanguage } from "./fixes";
import { readTree } from "@/program/document/tree";
import {
  EMPTY_DOCUMENT,
  type Diagnostic,
  type Fix,
  type ProgramDocument,
  type Step,
} from "@/program/document/document";

const fresh = { makeId: () => "new", robotName: (number: number) => `Robot ${number}` };

function mend(document: ProgramDocument, fix: Pick<Fix, "step" | "field" | "value">): ProgramDocument {
  return applyEdits(document, fixEdits(document, fix, fresh));
}

function withSteps(steps: Record<string, Step>): ProgramDocument {
  return { ...EMPTY_DOCUMENT, steps };
}

test("a remedy sets the value inside the arguments and leaves the others", () => {
  const document = withSteps({ s: { kind: "operate", place: null, params: { args: { time: null, shade: "teal" } } } });
  const mended = mend(document, { step: "s", field: "args.time", value: 6 });
  expect(mended.steps.s?.params).toEqual({ args: { time: 6, shade: "teal" } });
});

test("a draft is joined to the end of the program", () => {
  const document = withSteps({ s: { kind: "wait", place: null, params: {} } });
  const mended = mend(document, { step: "s", field: "place", value: ["program", "body"] });
  expect(readTree(mended).reading).toEqual(["s"]);
});

test("a step that is never reached is deleted with all inside it", () => {
  const document = withSteps({
    end: { kind: "end", place: ["program", "body", "A"], params: {} },
    loop: { kind: "while", place: ["program", "body", "B"], params: {} },
    inner: { kind: "wait", place: ["loop", "body", "A"], params: {} },
  });
  expect(Object.keys(mend(document, { step: "loop", field: "delete", value: null }).steps)).toEqual(["end"]);
});

test("a Return outside a function ends the program instead", () => {
  const document = withSteps({ s: { kind: "return", place: ["program", "body", "A"], params: { value: 1 } } });
  expect(mend(document, { step: "s", field: "kind", value: "end" }).steps.s).toEqual({
    kind: "end",
    place: ["program", "body", "A"],
    params: {},
  });
});

test("one branch of a Parallel gets a robot of its own, also for the steps inside others", () => {
  const document: ProgramDocument = {
    ...withSteps({
      p: { kind: "parallel", place: ["program", "body", "A"], params: {} },
      a: { kind: "move", place: ["p", "a", "A"], params: {} },
      loop: { kind: "while", place: ["p", "b", "A"], params: {} },
      b: { kind: "pick", place: ["loop", "body", "A"], params: { role: "robot" } },
      other: { kind: "drop", place: ["p", "b", "B"], params: { role: "arm" } },
    }),
    roles: { arm: { name: "arm" } },
  };
  const mended = mend(document, { step: "p", field: "robot_of", value: { branch: "b", role: "robot" } });
  expect(mended.roles.new).toEqual({ name: "Robot 3", can: [] });
  expect(["a", "b", "other"].map((id) => mended.steps[id]?.params.role)).toEqual([undefined, "new", "arm"]);
});

test("a remedy for a step that is gone changes nothing", () => {
  expect(fixEdits(EMPTY_DOCUMENT, { step: "gone", field: "quantity", value: 1 }, fresh)).toEqual([]);
});

test("what could not be read of a role is taken out, and what could is kept", () => {
  const document = { ...EMPTY_DOCUMENT, roles: { arm: { name: "Arm", can: ["pick"] } } };
  const edits = fixEdits(document, { step: "", field: "part", value: { root: "roles", part: "arm" } }, fresh);
  expect(edits).toEqual([{ do: "set_role", id: "arm", value: { name: "Arm", can: ["pick"] } }]);
  expect(fixEdits(EMPTY_DOCUMENT, { step: "", field: "part", value: { root: "roles", part: "arm" } }, fresh)).toEqual(
    [],
  );
});

test("a version of the library is told apart from other remedies", () => {
  const value = { function: "f", library: "lib", version: 3 };
  expect(versionOf({ step: "s", field: "source.version", value })).toEqual(value);
  expect(versionOf({ step: "s", field: "source.version", value: 3 })).toBeNull();
  expect(versionOf({ step: "s", field: "quantity", value })).toBeNull();
});

test("problems and their remedies are shown in the language of the screen", () => {
  const problem: Diagnostic = {
    code: "draft",
    severity: "warning",
    step: "s",
    field: "place",
    message: "Join it.",
    when: "ever",
    args: {},
    line: null,
    messages: { en: "Join it.", de: "Verbinden Sie ihn." },
    fix: {
      label: "Join",
      labels: { en: "Join", de: "Verbinden" },
      label_code: "join",
      step: "s",
      field: "place",
      value: null,
    },
  };
  const [german] = inLanguage([problem], "de-AT");
  const [english] = inLanguage([problem], "en");
  expect([german?.message, german?.fix?.label]).toEqual(["Verbinden Sie ihn.", "Verbinden"]);
  expect([english?.message, english?.fix?.label]).toEqual(["Join it.", "Join"]);
});
