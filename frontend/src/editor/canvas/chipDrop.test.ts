import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { buildScene } from "@/program/scene/scene";
import { surroundingsOf } from "@/program/surroundings";
import { applyEdits, type Edit } from "../edits/edits";
import type { OpenProgram } from "../state/context";
import { resetUi, useUi } from "../state/ui";
import { moveChips } from "./chipDrop";

const step = (kind: string, pos: Step["pos"], parent: string): Step => {
  return { kind, pos, place: [parent, "body", "a"], params: {} };
};

test("a loop that is let go where the loop in it stood is moved, and nothing is said of going back", () => {
  resetUi();
  let document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    steps: {
      outer: step("while", [5, -3], "program"),
      inner: step("while", [5, -4.2], "outer"),
      wait: step("wait", [5, -5.4], "inner"),
    },
  };
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
  const open = { document, scene, apply, t } as unknown as OpenProgram;
  expect(scene.frames.find(({ id }) => id === "outer")?.holds).toEqual(new Set(["inner"]));
  moveChips(open, [{ id: "outer", at: [5, -4.2], pointed: [5, -4.2] }]);
  expect(useUi.getState().toast).toBeNull();
  expect(document.steps.outer).toMatchObject({ pos: [5, -4.2], place: ["program", "body", "a"] });
});
