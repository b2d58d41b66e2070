import { expect, test } from "vitest";
import { applyEdits, type Edit } from "./edits";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";
import { asTheyAre, changedSince, workedOnSince } from "./undo";

const step = { kind: "wait", place: ["program", "body", "A"], pos: [1, -1], params: { duration: 5 } } as const;
const before: ProgramDocument = { ...EMPTY_DOCUMENT, steps: { a: step, b: step } };
const mine: readonly Edit[] = [
  { do: "set_place", id: "a", place: null },
  { do: "set_place", id: "a", place: ["program", "body", "B"] },
  { do: "set_param", id: "a", name: "duration", value: null },
];
const after = applyEdits(before, mine);

test("what I set is as I set it while nobody touches it", () => {
  expect(changedSince(after, mine)).toBe(false);
  expect(changedSince(applyEdits(after, [{ do: "set_pos", id: "a", pos: [2, 2] }]), mine)).toBe(false);
  expect(changedSince(applyEdits(after, [{ do: "set_param", id: "b", name: "duration", value: 7 }]), mine)).toBe(false);
});

test("somebody who changes the same field changes it after me", () => {
  expect(changedSince(applyEdits(after, [{ do: "set_param", id: "a", name: "duration", value: 7 }]), mine)).toBe(true);
  expect(changedSince(applyEdits(after, [{ do: "set_place", id: "a", place: null }]), mine)).toBe(true);
});

test("a step that has gone, or that I added or removed, stands in nobody's way", () => {
  expect(changedSince(applyEdits(after, [{ do: "remove_step", id: "a" }]), mine)).toBe(false);
  expect(changedSince(before, [{ do: "add_step", id: "a", step: { ...step, pos: [9, 9] } }])).toBe(false);
});

test("zones, functions and the start count as well", () => {
  expect(changedSince(before, [{ do: "set_start", pos: [3, 3] }])).toBe(true);
  expect(changedSince(before, [{ do: "set_zone", id: "z", value: null }])).toBe(false);
  expect(changedSince(before, [{ do: "set_function", id: "f", value: { name: "f", parameters: [] } }])).toBe(true);
});

test("a step that I removed and somebody put back was changed after me", () => {
  expect(changedSince(before, [{ do: "remove_step", id: "a" }])).toBe(true);
  expect(changedSince(applyEdits(before, [{ do: "remove_step", id: "a" }]), [{ do: "remove_step", id: "a" }])).toBe(
    false,
  );
});

test("what was set is told as it is now, each field once", () => {
  const edits: readonly Edit[] = [
    ...mine,
    { do: "set_pos", id: "b", pos: [9, 9] },
    { do: "set_start", pos: [3, 3] },
    { do: "set_zone", id: "z", value: null },
    { do: "remove_step", id: "b" },
    { do: "add_step", id: "c", step },
    { do: "set_param", id: "c", name: "duration", value: 7 },
  ];
  expect(asTheyAre({ ...before, start_pos: [1, 1] }, edits)).toEqual([
    { do: "set_place", id: "a", place: step.place },
    { do: "set_param", id: "a", name: "duration", value: 5 },
    { do: "set_pos", id: "b", pos: step.pos },
    { do: "set_start", pos: [1, 1] },
    { do: "set_zone", id: "z", value: null },
    { do: "add_step", id: "b", step },
    { do: "remove_step", id: "c" },
    { do: "set_param", id: "c", name: "duration", value: 7 },
  ]);
  expect(changedSince(before, asTheyAre(before, edits))).toBe(false);
});

const added: readonly Edit[] = [
  { do: "add_step", id: "loop", step: { kind: "repeat", place: null, pos: null, params: { times: 2 } } },
  { do: "set_param", id: "loop", name: "times", value: 3 },
  { do: "set_place", id: "a", place: ["loop", "body", "A"] },
];

test("a step that I added is worked on by who changes anything in it, or draws into it", () => {
  const drawn = applyEdits(before, added);
  expect(workedOnSince(drawn, added)).toBe(false);
  for (const theirs of [
    { do: "set_param", id: "loop", name: "times", value: 4 },
    { do: "set_param", id: "loop", name: "note", value: "slowly" },
    { do: "set_pos", id: "loop", pos: [4, 4] },
    { do: "set_place", id: "loop", place: ["program", "body", "B"] },
    { do: "set_place", id: "b", place: ["loop", "body", "B"] },
    { do: "add_step", id: "c", step: { ...step, place: ["loop", "body", "C"] } },
  ] satisfies Edit[])
    expect(workedOnSince(applyEdits(drawn, [theirs]), added)).toBe(true);
});

test("a step that I did not add, or that has gone, is no work to lose", () => {
  const drawn = applyEdits(before, added);
  expect(workedOnSince(applyEdits(drawn, [{ do: "set_param", id: "a", name: "duration", value: 9 }]), added)).toBe(
    false,
  );
  expect(workedOnSince(before, added)).toBe(false);
  expect(workedOnSince(applyEdits(after, [{ do: "set_pos", id: "a", pos: [2, 2] }]), mine)).toBe(false);
});

test("many steps are looked through at once", () => {
  const steps = Object.fromEntries(Array.from({ length: 10_000 }, (_, at) => [`s${at}`, step]));
  const all = Object.keys(steps).map((id): Edit => ({ do: "add_step", id, step }));
  expect(workedOnSince({ ...before, steps }, all)).toBe(false);
});

test("the same said in another order of its keys changes nothing", () => {
  const role: Edit = { do: "set_role", id: "r", value: { name: "Carrier", can: ["pick"] } };
  const again: Edit = { do: "set_role", id: "r", value: { can: ["pick"], name: "Carrier" } };
  expect(changedSince(applyEdits(before, [role, again]), [role])).toBe(false);
});
