import { beforeEach, expect, test, vi } from "vitest";
import * as Y from "yjs";
import type { Edit } from "../edits/edits";
import { FieldVisits } from "./fieldVisits";
import { readDocument, ROOTS } from "./snapshot";
import { editsOf, UndoList, type Way } from "./undoList";
import { writeEdit } from "./writer";

const ME = Symbol("me");
let doc: Y.Doc, undo: UndoList, visits: FieldVisits;

const write = (to: Y.Doc, edits: readonly Edit[], origin: unknown) =>
  to.transact(() => edits.forEach((edit) => writeEdit(to, edit)), origin);
const mine = (...edits: Edit[]) => visits.capture(edits, () => write(doc, edits, ME));
const others = (...edits: Edit[]) => {
  const theirs = new Y.Doc();
  Y.applyUpdate(theirs, Y.encodeStateAsUpdate(doc));
  write(theirs, edits, "them");
  Y.applyUpdate(doc, Y.encodeStateAsUpdate(theirs), "the server");
};
const lasts = (id: string, value: number): Edit => ({ do: "set_param", id, name: "duration", value });
const duration = (id: string) => readDocument(doc).steps[id]?.params.duration;
const keptBy = (way: Way) => {
  const entry = undo.next(way);
  return entry && editsOf(entry);
};

beforeEach(() => {
  doc = new Y.Doc();
  const step = { kind: "wait", place: ["program", "body", "A"], pos: [1, -1], params: { duration: 1 } } as const;
  const added = ["a", "b"].map((id): Edit => ({ do: "add_step", id, step }));
  write(doc, added, null);
  const roots = ROOTS.map((name) => doc.getMap(name));
  const trackedOrigins = new Set([ME]);
  const manager = new Y.UndoManager(roots, { trackedOrigins, captureTimeout: 0, ignoreRemoteMapChanges: true });
  undo = new UndoList(manager);
  visits = new FieldVisits(manager);
});

test("an entry knows what it set in the program, also as undoing and redoing it set it", () => {
  mine(lasts("a", 2), lasts("a", 3));
  expect(keptBy("undo")).toEqual([lasts("a", 2), lasts("a", 3)]);
  others(lasts("a", 5));
  mine(lasts("a", 9));
  expect(undo.carryOut("undo")).toBe(true);
  expect(keptBy("redo")).toEqual([lasts("a", 5)]);
  undo.carryOut("redo");
  expect(keptBy("undo")).toEqual([lasts("a", 9)]);
  expect(undo.length).toBe(2);
});

test("a step that was added is away once that is undone, and there once it is done again", () => {
  const step = { kind: "wait", place: null, pos: [2, 2], params: { duration: 4 } } as const;
  mine({ do: "add_step", id: "c", step }, lasts("c", 7));
  undo.carryOut("undo");
  expect(keptBy("redo")).toEqual([{ do: "remove_step", id: "c" }, lasts("c", 7)]);
  undo.carryOut("redo");
  const added: Edit = { do: "add_step", id: "c", step: { ...step, params: { duration: 7 } } };
  expect(keptBy("undo")).toEqual([added, lasts("c", 7)]);
});

test("an entry of which nothing is left takes back no older one, neither undone nor redone", () => {
  mine(lasts("a", 2));
  mine(lasts("b", 9));
  others({ do: "remove_step", id: "b" });
  expect(undo.carryOut("undo")).toBe(false);
  expect([duration("a"), undo.length]).toEqual([2, 1]);
  expect(undo.carryOut("undo")).toBe(true);
  expect([duration("a"), undo.length]).toEqual([1, 0]);
  expect(undo.carryOut("undo")).toBe(false);
});

test("done again is one entry alone, too", () => {
  mine(lasts("b", 9));
  mine(lasts("a", 2));
  undo.carryOut("undo");
  undo.carryOut("undo");
  others({ do: "remove_step", id: "b" });
  expect(undo.carryOut("redo")).toBe(false);
  expect(duration("a")).toBe(1);
  expect(undo.carryOut("redo")).toBe(true);
  expect(duration("a")).toBe(2);
});

test("who listens hears of each change once all of the list is there", () => {
  const seen: (readonly [number, boolean])[] = [];
  const listen = vi.fn(() => seen.push([undo.length, undo.next("redo") !== null]));
  const stop = undo.subscribe(listen);
  mine(lasts("a", 2));
  mine(lasts("a", 3));
  undo.carryOut("undo");
  expect(seen.at(-1)).toEqual([1, true]);
  expect(seen.every(([length]) => length > 0)).toBe(true);
  others({ do: "remove_step", id: "a" });
  undo.carryOut("undo");
  expect(seen.at(-1)).toEqual([0, true]);
  stop();
  listen.mockClear();
  undo.carryOut("redo");
  expect(listen).not.toHaveBeenCalled();
});
