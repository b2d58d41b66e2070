// @vitest-environment jsdom
import { act, cleanup, render } from "@testing-library/react";
import { afterEach, beforeEach, expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import type { SharedProgram } from "../shared/sharedProgram";
import { ProgramContext, type OpenProgram } from "../state/context";
import { resetGestures, useGestures } from "../state/gestures";
import { resetUi, select, useUi } from "../state/ui";
import { Ghosts } from "./Ghosts";

const wait = (x: number, parent = "program"): Step => {
  return { kind: "wait", place: [parent, "body", "a"], pos: [x, -1], params: {} };
};
const document: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  functions: { mix: { name: "mix", parameters: [] } },
  steps: { a: wait(1, "mix"), b: wait(2), call: { ...wait(3), kind: "call", params: { function: "mix" } } },
};

beforeEach(() => {
  resetUi();
  resetGestures();
});
afterEach(cleanup);

/** Somebody else removes step a, with what goes and comes in the same change. */
function remove(brought: Record<string, Step>, gone = ["a", "call"], unsaved = false) {
  const listeners: Parameters<SharedProgram["onRemoval"]>[0][] = [];
  const shared = {
    onRemoval: (each: (typeof listeners)[0]) => void listeners.push(each),
    getDocument: () => document,
    isUnsaved: (id: string) => unsaved && id === "a",
  };
  // Whoever may not edit is shown none, and so no map is needed here.
  const scene = { chips: new Map([["a", { at: { x: 60, y: 40 } }]]) };
  const open = { document, shared, scene, canEdit: false } as unknown as OpenProgram;
  select(["a", "b"]);
  render(
    <ProgramContext value={open}>
      <Ghosts />
    </ProgramContext>,
  );
  act(() => listeners.forEach((each) => each(gone, brought)));
  return { ghosts: useGestures.getState().ghosts.map(({ id }) => id), selected: useUi.getState().selected };
}

test("a selected step that somebody removes is kept to be brought back", () => {
  expect(remove({ c: wait(3) })).toEqual({ ghosts: ["a"], selected: ["b"] });
});

test("one is kept to be brought back though another of its kind comes to its spot", () => {
  expect(remove({ d: wait(1) }, ["a"])).toEqual({ ghosts: ["a"], selected: ["b"] });
});

test("one whose function is expanded, and that the same change brings under another name stays selected, and nothing is said", () => {
  expect(remove({ c: wait(3), d: wait(1) })).toEqual({ ghosts: [], selected: ["d", "b"] });
});

test("a change of it that the copy does not have is told all the same", () => {
  expect(remove({ d: wait(1) }, ["a", "call"], true)).toEqual({ ghosts: ["a"], selected: ["d", "b"] });
});

test("its words stand where it was drawn, also where it has no place of its own", () => {
  remove({}, ["a"]);
  expect(useGestures.getState().ghosts[0]?.at).toEqual({ x: 60, y: 40 });
});
