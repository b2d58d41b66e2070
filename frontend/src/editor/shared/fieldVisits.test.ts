import { beforeEach, expect, test } from "vitest";
import * as Y from "yjs";
import type { Edit } from "../edits/edits";
import { FieldVisits } from "./fieldVisits";
import { editsOf } from "./undoList";

const ME = Symbol("me");
let doc: Y.Doc, undo: Y.UndoManager, visits: FieldVisits;
const fields = () => doc.getMap("steps");
const store = (name: string, value: unknown) => {
  const edits: readonly Edit[] = [{ do: "set_param", id: "a", name, value }];
  visits.capture(edits, () => doc.transact(() => fields().set(name, value), ME));
};
const others = (name: string, value: unknown) => {
  const theirs = new Y.Doc();
  Y.applyUpdate(theirs, Y.encodeStateAsUpdate(doc));
  theirs.getMap("steps").set(name, value);
  Y.applyUpdate(doc, Y.encodeStateAsUpdate(theirs), "the server");
};

beforeEach(() => {
  doc = new Y.Doc();
  fields().set("time", 3);
  undo = new Y.UndoManager([fields()], {
    trackedOrigins: new Set([ME]),
    captureTimeout: 0,
    ignoreRemoteMapChanges: true,
  });
  visits = new FieldVisits(undo);
});

test("what a visit stores in parts is one entry, undone and done again as a whole", () => {
  visits.begin();
  for (const value of [1, 12, 120]) store("time", value);
  visits.end();
  expect(undo.undoStack).toHaveLength(1);
  const [entry] = undo.undoStack;
  expect(entry && editsOf(entry).map((edit) => "value" in edit && edit.value)).toEqual([1, 12, 120]);
  undo.undo();
  expect(fields().get("time")).toBe(3);
  undo.redo();
  expect(fields().get("time")).toBe(120);
});

test("each visit has an entry of its own, and so has each gesture without one", () => {
  for (const value of [5, 6]) {
    visits.begin();
    store("time", value);
    visits.end();
  }
  store("time", 7);
  store("time", 8);
  expect(undo.undoStack).toHaveLength(4);
  undo.undo();
  undo.undo();
  expect(fields().get("time")).toBe(6);
  undo.undo();
  expect(fields().get("time")).toBe(5);
});

test("what others change meanwhile stays, and does not part the visit", () => {
  visits.begin();
  store("time", 1);
  others("message", "theirs");
  store("time", 12);
  others("message", "theirs again");
  visits.end();
  expect(undo.undoStack).toHaveLength(1);
  undo.undo();
  expect(fields().toJSON()).toEqual({ time: 3, message: "theirs again" });
});

test("a field that somebody else sets, too, keeps no value of the visit", () => {
  visits.begin();
  store("time", 1);
  others("time", 40);
  store("time", 12);
  visits.end();
  undo.undo();
  expect(fields().get("time")).toBe(40);
});

test("an answer that comes after the visit belongs to it, unless something was drawn since", () => {
  visits.begin();
  const visit = visits.now;
  store("time", 1);
  visits.begin();
  visits.during(visit, () => store("time", 12));
  expect(undo.undoStack).toHaveLength(1);
  expect(visits.now).not.toBe(visit);
  store("message", "next field");
  visits.during(visit, () => store("time", 120));
  expect(undo.undoStack).toHaveLength(3);
  undo.undo();
  expect(fields().toJSON()).toEqual({ time: 12, message: "next field" });
});

test("what changes nothing takes no entry of before into its visit", () => {
  store("time", 5);
  visits.begin();
  visits.capture([{ do: "remove_step", id: "gone" }], () => doc.transact(() => {}, ME));
  store("time", 6);
  visits.end();
  expect(undo.undoStack).toHaveLength(2);
  undo.undo();
  expect(fields().get("time")).toBe(5);
});
