/** What the keys do to steps on the map is what dragging them does. */
import { beforeEach, expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { readTree } from "@/program/document/tree";
import { buildScene } from "@/program/scene/scene";
import { surroundingsOf } from "@/program/surroundings";
import { moveChips } from "../canvas/chipDrop";
import { EDIT_COMMANDS } from "../commands/editing";
import type { On } from "../commands/command";
import { applyEdits, type Edit } from "../edits/edits";
import type { OpenProgram } from "../state/context";
import { resetUi, select } from "../state/ui";
import { enterMove, pressInMode, useMode } from "./modes";

const step = (kind: string, pos: Step["pos"], parent: string, order = "a"): Step => {
  return { kind, pos, place: [parent, "body", order], params: {} };
};
/** A loop with a loop in it; its last step stands at a machine far away. */
const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: {
    outer: step("while", [5, -3], "program"),
    inner: step("while", [5, -3.8], "outer"),
    wait: step("wait", [5, -4.6], "inner"),
    far: step("wait", [15, -9], "outer", "b"),
  },
};
let document: ProgramDocument;

function open(): OpenProgram {
  const t = (key: string) => key;
  const scene = buildScene({
    document,
    compiled: { numbers: {}, diagnostics: [], added_moves: [] },
    surroundings: surroundingsOf([], []),
    floor: null,
    routes: () => undefined,
    collapsed: new Set(),
    t,
    measure: (text) => text.length * 7,
  });
  const apply = (edits: readonly Edit[]) => (document = applyEdits(document, edits));
  return { document, scene, apply, devices: [], plan: null, t } as unknown as OpenProgram;
}

const places = () => Object.fromEntries(Object.entries(document.steps).map(([id, { pos }]) => [id, pos]));

/** What the mouse does: the head of the outer loop two metres to the right. */
function dragged() {
  document = DOCUMENT;
  moveChips(open(), [{ id: "outer", at: [7, -3], pointed: [7, -3] }]);
  return places();
}

beforeEach(() => {
  resetUi();
  select(["outer"]);
  document = DOCUMENT;
});

test("a frame that is put elsewhere by keyboard takes along what stands in it, as it does when it is dragged", () => {
  const mode = { kind: "place", steps: ["outer"], from: [5, -3], at: [7, -3], landmark: -1 } as const;
  pressInMode(open(), mode, { key: "Enter", shiftKey: false });
  const put = places();
  expect(put).toEqual({ outer: [7, -3], inner: [7, -3.8], wait: [7, -4.6], far: [15, -9] });
  expect(dragged()).toEqual(put);
});

test("a frame that is nudged takes along what stands in it, once each also where that is selected, too", () => {
  const nudge = EDIT_COMMANDS.find(({ id }) => id === "nudge_far");
  select(["outer", "wait"]);
  for (let press = 0; press < 4; press += 1) nudge?.run(open(), { keys: "Alt+Shift+ArrowRight" } as On);
  expect(places()).toEqual(dragged());
});

test("in the mode that moves, a spot that somebody took away meanwhile is looked for anew, and the step stays", () => {
  const program: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    steps: Object.fromEntries(["a", "b", "c", "d"].map((id) => [id, step("wait", [1, -1], "program", id)])),
  };
  const inOrder = () => readTree(document).children("program", "body");
  const press = (key: string) => {
    const { mode } = useMode.getState();
    if (mode) pressInMode(open(), mode, { key, shiftKey: false });
  };
  document = program;
  select(["d"]);
  enterMove(open());
  press("ArrowUp");
  document = applyEdits(document, [{ do: "remove_step", id: "b" }]);
  press("Enter");
  expect(inOrder()).toEqual(["a", "c", "d"]);
  expect(useMode.getState().mode).toMatchObject({ kind: "move", at: 2 });
  expect(useMode.getState().words).toContain("refused.gone");
  press("ArrowUp");
  press("Enter");
  expect(inOrder()).toEqual(["a", "d", "c"]);
  expect(useMode.getState().mode).toBeNull();
});
