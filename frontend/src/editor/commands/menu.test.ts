// @vitest-environment jsdom
/** What a menu offers is done to the program as it is when the item is chosen. */
import { afterEach, beforeEach, expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { toMetres } from "@/map/plane/projection";
import { applyEdits, type Edit } from "../edits/edits";
import type { OpenProgram } from "../state/context";
import { resetGestures, useGestures } from "../state/gestures";
import { useScreen } from "../state/screen";
import { resetUi, select, useUi } from "../state/ui";
import { selection } from "./command";
import { EDIT_COMMANDS } from "./editing";
import { itemsOf, showMenuByKey } from "./menu";

const step = (kind: string, parent = "program", order = "A"): Step => {
  return { kind, place: [parent, "body", order], pos: [1, -1], params: {} };
};
let document: ProgramDocument;

function open(canEdit = true): OpenProgram {
  const apply = (edits: readonly Edit[]) => (document = applyEdits(document, edits));
  const shared = { undo: { next: () => null } };
  const chips = new Map([["wait", { id: "wait", at: { x: 92, y: 46 } }]]);
  const scene = { chips, frames: [], links: [] };
  const surroundings = { devices: new Map() };
  return { document, apply, shared, canEdit, scene, surroundings, t: (key: string) => key } as unknown as OpenProgram;
}

beforeEach(() => {
  resetUi();
  resetGestures();
  document = { ...EMPTY_DOCUMENT, steps: { loop: step("while"), wait: step("wait", "loop") } };
});
afterEach(() => useScreen.setState({ stage: null }));

const itemOf = (id: string) => itemsOf(EDIT_COMMANDS, "step", open(), selection()).find((each) => each.id === id);

test("a loop that is deleted from its menu leaves a step that somebody dragged out of it while the menu was open", () => {
  select(["loop"]);
  const item = itemOf("delete");
  document = applyEdits(document, [{ do: "set_place", id: "wait", place: ["program", "body", "B"] }]);
  item?.run(open());
  expect(Object.keys(document.steps)).toEqual(["wait"]);
});

test("what cannot be done any more when it is chosen is not done, and a word says why", () => {
  select(["loop"]);
  itemOf("delete")?.run(open(false));
  expect(Object.keys(document.steps)).toEqual(["loop", "wait"]);
  expect(useUi.getState().toast).not.toBeNull();
});

test("the menu of a step that has no place of its own opens where the step is drawn", () => {
  document = { ...document, steps: { ...document.steps, wait: { ...step("wait"), pos: null } } };
  const flow = { flowToScreenPosition: (at: { x: number; y: number }) => at };
  useScreen.setState({ stage: { flow } as never });
  select(["wait"]);
  showMenuByKey(EDIT_COMMANDS, open(), null);
  const { at } = useGestures.getState().menu ?? {};
  expect(at && toMetres(at)).toEqual([2, -1]);
});
