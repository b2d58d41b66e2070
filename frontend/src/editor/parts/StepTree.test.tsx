// @vitest-environment jsdom
import { fireEvent } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { EMPTY_DOCUMENT, type Step } from "@/program/document/document";
import { buildScene } from "@/program/scene/scene";
import { surroundingsOf } from "@/program/surroundings";
import { show, testsPages } from "@/testing/page";
import { ProgramContext, type OpenProgram } from "../state/context";
import { resetUi, useUi } from "../state/ui";
import { StepTree } from "./StepTree";

testsPages();

test("keys walk through steps whatever their ids are", () => {
  vi.stubGlobal("CSS", { escape: (text: string) => text.replaceAll('"', '\\"') });
  resetUi();
  const step = (order: string): Step => {
    return { kind: "wait", place: ["program", "body", order], pos: [1, -1], params: { duration: 1 } };
  };
  const document = { ...EMPTY_DOCUMENT, steps: { one: step("A"), 'the "other"': step("B") } };
  const t = (key: string) => key;
  const surroundings = surroundingsOf([], []);
  const scene = buildScene({
    document,
    compiled: { numbers: {}, diagnostics: [], added_moves: [] },
    surroundings,
    floor: null,
    routes: () => undefined,
    collapsed: new Set(),
    t,
    measure: (text) => text.length * 7,
  });
  const speaker = { document, surroundings, t };
  const open = { document, scene, surroundings, speaker, people: [], t } as unknown as OpenProgram;
  const { container } = show(
    <ProgramContext value={open}>
      <StepTree />
    </ProgramContext>,
  );
  const [first, second] = container.querySelectorAll<HTMLElement>("[data-step]");
  if (first) fireEvent.keyDown(first, { key: "ArrowDown" });
  expect(useUi.getState().selected).toEqual(['the "other"']);
  expect(window.document.activeElement).toBe(second);
});
