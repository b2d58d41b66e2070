import { expect, test } from "vitest";
import * as Y from "yjs";
import { applyEditsToDoc } from "../shared/sharedProgram";
import { readDocument } from "../shared/snapshot";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { differenceOf, withFreshIds } from "./difference";

function wait(order: string, duration: unknown, more: Record<string, unknown> = {}): Step {
  return { kind: "wait", place: ["program", "body", order], pos: [1, -1], params: { duration, ...more } };
}

const BASE: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  start_pos: [0, 0],
  steps: { a: wait("1", 60), b: wait("2", 5, { timeout: 9 }) },
  functions: { f: { name: "Mix", parameters: [] } },
  roles: { robot: { name: "robot", can: [] } },
};

function shared(document: ProgramDocument): Y.Doc {
  const doc = new Y.Doc();
  applyEditsToDoc(doc, differenceOf(EMPTY_DOCUMENT, document));
  return doc;
}

function copyOf(doc: Y.Doc): Y.Doc {
  const copy = new Y.Doc();
  Y.applyUpdate(copy, Y.encodeStateAsUpdate(doc));
  return copy;
}

function meet(first: Y.Doc, second: Y.Doc): void {
  Y.applyUpdate(first, Y.encodeStateAsUpdate(second));
  Y.applyUpdate(second, Y.encodeStateAsUpdate(first));
  expect(readDocument(first)).toEqual(readDocument(second));
}

test("nothing differs from itself", () => {
  expect(differenceOf(BASE, structuredClone(BASE))).toEqual([]);
});

test("a zone that a script adds, changes or takes out is one edit", () => {
  const corners: [number, number][] = [
    [1, 2],
    [4, 2],
    [4, 5],
  ];
  const wet = { name: "Wet floor", rule: "keep_out", points: corners } as const;
  const before = { ...BASE, zones: { z1: wet, z2: wet } };
  const next = { ...BASE, zones: { z1: { ...wet, rule: "slow" as const }, hall: wet } };
  expect(differenceOf(before, next)).toEqual([
    { do: "set_zone", id: "z1", value: { ...wet, rule: "slow" } },
    { do: "set_zone", id: "hall", value: wet },
    { do: "set_zone", id: "z2", value: null },
  ]);
  expect(readDocument(shared(next)).zones).toEqual(next.zones);
});

test("one number is one edit", () => {
  const next = { ...BASE, steps: { ...BASE.steps, a: wait("1", 61) } };
  expect(differenceOf(BASE, next)).toEqual([{ do: "set_param", id: "a", name: "duration", value: 61 }]);
});

test("added, moved and removed steps, functions and roles", () => {
  const next: ProgramDocument = {
    ...BASE,
    steps: { a: wait("3", 60), c: wait("2", 7) },
    functions: {},
    roles: { robot: { name: "robot", device: "robot01" } },
    parameters: { n: { name: "n", type: "number", unit: "" } },
  };
  const doc = shared(BASE);
  applyEditsToDoc(doc, differenceOf(BASE, next));
  expect(readDocument(doc)).toEqual({ ...next, start_pos: null });
  expect(differenceOf(BASE, next).map((edit) => edit.do)).toEqual([
    "set_role",
    "set_function",
    "set_parameter",
    "set_place",
    "add_step",
    "remove_step",
  ]);
});

test("two people's edits of different fields both survive", () => {
  const mine = shared(BASE);
  const theirs = copyOf(mine);
  applyEditsToDoc(mine, differenceOf(BASE, { ...BASE, steps: { ...BASE.steps, b: wait("2", 6, { timeout: 9 }) } }));
  applyEditsToDoc(theirs, [
    { do: "set_param", id: "b", name: "timeout", value: 20 },
    { do: "set_pos", id: "b", pos: [4, -4] },
    { do: "add_step", id: "z", step: wait("9", 1) },
  ]);
  meet(mine, theirs);
  const { steps } = readDocument(mine);
  expect(steps.b).toEqual({ ...wait("2", 6, { timeout: 20 }), pos: [4, -4] });
  expect(Object.keys(steps).sort()).toEqual(["a", "b", "z"]);
});

test("a step that somebody removed meanwhile stays removed", () => {
  const mine = shared(BASE);
  applyEditsToDoc(mine, [{ do: "remove_step", id: "a" }]);
  applyEditsToDoc(mine, differenceOf(BASE, { ...BASE, steps: { ...BASE.steps, a: wait("1", 61) } }));
  expect(Object.keys(readDocument(mine).steps)).toEqual(["b"]);
});

test("two people who draw the same new id draw two steps", () => {
  const [mine, theirs] = [shared(BASE), shared(BASE)];
  Y.applyUpdate(theirs, Y.encodeStateAsUpdate(mine));
  Y.applyUpdate(mine, Y.encodeStateAsUpdate(theirs));
  let count = 0;
  for (const doc of [mine, theirs]) {
    const drawn = { document: { ...BASE, steps: { ...BASE.steps, s1: wait("3", 7) } }, lines: ["", "s1"] };
    const fresh = withFreshIds(drawn, BASE, () => `fresh${(count += 1)}`);
    expect(fresh.lines).toEqual(["", `fresh${count}`]);
    applyEditsToDoc(doc, differenceOf(BASE, fresh.document));
  }
  meet(mine, theirs);
  expect(Object.keys(readDocument(mine).steps).sort()).toEqual(["a", "b", "fresh1", "fresh2"]);
});

test("fresh ids reach parents and calls", () => {
  const inner: Step = { kind: "wait", place: ["mix", "body", "V"], pos: null, params: {} };
  const call: Step = { kind: "call", place: ["s1", "then", "V"], pos: null, params: { function: "mix", args: {} } };
  const branch: Step = { kind: "if", place: ["program", "body", "5"], pos: null, params: {} };
  const document = {
    ...BASE,
    steps: { ...BASE.steps, s1: branch, s2: call, s3: inner },
    functions: { ...BASE.functions, mix: { name: "mix", parameters: [] } },
  };
  let count = 0;
  const fresh = withFreshIds({ document, lines: [] }, BASE, () => `n${(count += 1)}`).document;
  expect(Object.keys(fresh.functions)).toEqual(["f", "n4"]);
  expect(fresh.steps.n2?.place).toEqual(["n1", "then", "V"]);
  expect(fresh.steps.n2?.params).toEqual({ function: "n4", args: {} });
  expect(fresh.steps.n3?.place).toEqual(["n4", "body", "V"]);
});
