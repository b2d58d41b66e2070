import { expect, test, vi } from "vitest";
import * as Y from "yjs";
import { SharedProgram } from "./sharedProgram";
import { changedBy, readDocument, rereadDocument, ROOTS } from "./snapshot";

function docWithSteps(): Y.Doc {
  const doc = new Y.Doc();
  for (const id of ["a", "b"]) {
    const step = new Y.Map<unknown>();
    step.set("kind", "wait");
    step.set("place", ["program", "body", id]);
    step.set("pos", [1, 2]);
    step.set("params", new Y.Map([["duration", 3]]));
    doc.getMap("steps").set(id, step);
  }
  return doc;
}

test("a change of one step leaves the other steps the very same objects", () => {
  const doc = docWithSteps();
  const before = readDocument(doc);
  const changed = new Map<string, Set<string>>();
  for (const root of ROOTS) doc.getMap(root).observeDeep((events) => changed.set(root, changedBy(root, events)));
  const step = doc.getMap<Y.Map<Y.Map<unknown>>>("steps").get("a");
  step?.get("params")?.set("duration", 9);
  const next = rereadDocument(doc, before, changed);
  expect(next.steps.a?.params).toEqual({ duration: 9 });
  expect(next.steps.b).toBe(before.steps.b);
});

test("a removed step is gone from the plain document", () => {
  const doc = docWithSteps();
  const before = readDocument(doc);
  doc.getMap("steps").delete("a");
  const next = rereadDocument(doc, before, new Map([["steps", new Set(["a"])]]));
  expect(Object.keys(next.steps)).toEqual(["b"]);
});

test("nonsense written by somebody else reads as an empty draft", () => {
  const doc = new Y.Doc();
  doc.getMap("steps").set("x", 7);
  doc.getMap("meta").set("start_pos", "left");
  expect(readDocument(doc).steps.x).toEqual({ kind: "", place: null, pos: null, params: {} });
  expect(readDocument(doc).start_pos).toBeNull();
});

test("who removes steps is heard with what the same change brings", () => {
  const [theirs, own] = [docWithSteps(), new Y.Doc()];
  Y.applyUpdate(own, Y.encodeStateAsUpdate(theirs));
  const listener = vi.fn();
  SharedProgram.prototype.onRemoval.call({ doc: own } as SharedProgram, listener);
  theirs.transact(() => {
    theirs.getMap("steps").delete("a");
    theirs.getMap("steps").set("c", new Y.Map(Object.entries({ kind: "wait", pos: [1, 2] })));
  });
  Y.applyUpdate(own, Y.encodeStateAsUpdate(theirs));
  const brought = { c: { kind: "wait", place: null, pos: [1, 2], params: {} } };
  expect(listener.mock.calls).toEqual([[["a"], brought]]);
});
