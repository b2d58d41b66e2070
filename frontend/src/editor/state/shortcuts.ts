/** The keys of the editor; single letters rest while a field has focus. */
import { useLayoutEffect } from "react";
import { flushSync } from "react-dom";
import { shiftStep } from "../edits/joints";
import type { Position } from "@/program/document/document";
import { undoLast, duplicateSelected, nudgeSelected, removeSelected } from "./actions";
import { TOOLS } from "./tools";
import { useOpenProgram, type OpenProgram } from "./context";
import { createOnFloor } from "./newStep";
import { freeSpot } from "./freeSpot";
import { isTyping, takesLetters } from "./focus";
import { chooseNextBranch } from "./nextPlace";
import { askOf, RESTING, stepBack, takeTool } from "./tool";
import { say, select, showTab, useUi } from "./ui";

export function useShortcuts(): void {
  const open = useOpenProgram();
  // Before the next key is heard: what is on the screen and what the keys mean change together.
  useLayoutEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (event.defaultPrevented || useUi.getState().dialog || isTaken(event)) return;
      const control = event.ctrlKey || event.metaKey;
      const done = control ? controlKey(open, event) : plainKey(open, event);
      if (done) event.preventDefault();
    };
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  }, [open]);
}

/** Letters, and letters with Ctrl, pass where nothing is written; all other keys belong to the field. */
function isTaken(event: KeyboardEvent): boolean {
  const letter = event.key.length === 1 && event.key !== " " && !event.altKey;
  return letter ? takesLetters(event.target) : isTyping(event.target);
}

function controlKey(open: OpenProgram, event: KeyboardEvent): boolean {
  const { document, apply, shared, canEdit, canRun } = open;
  const key = event.key.toLowerCase();
  if (key === "j") {
    useUi.setState((ui) => ({ drawer: { ...ui.drawer, open: !ui.drawer.open } }));
    return true;
  }
  if (key === "enter" && !event.shiftKey && canRun) {
    useUi.setState({ dialog: "run" });
    return true;
  }
  if (key === "a") select(open.scene.tree.reading);
  if (!canEdit) return key === "a";
  const actions: Record<string, () => void> = {
    z: () => (event.shiftKey ? shared.undo.redo() : undoLast(open)),
    y: () => shared.undo.redo(),
    a: () => undefined,
    d: () => duplicateSelected(document, apply),
    g: () => {
      if (useUi.getState().selected.length > 0) useUi.setState({ dialog: "function" });
    },
  };
  const action = actions[key];
  action?.();
  return action !== undefined;
}

function plainKey(open: OpenProgram, event: KeyboardEvent): boolean {
  if (event.altKey) return moveKey(open, event);
  const kind = TOOLS.find((each) => each.key === event.key.toUpperCase());
  if (kind && open.canEdit) {
    useUi.setState((ui) => ({ gesture: takeTool(ui.gesture, kind.kind, true) }));
    return true;
  }
  switch (event.key) {
    case "v":
      useUi.setState({ gesture: RESTING });
      return true;
    case "h":
      useUi.setState({ gesture: takeTool(RESTING, "pan", false) });
      return true;
    case "b":
    case "B":
      return open.canEdit && chooseNextBranch(open, event.shiftKey ? -1 : 1);
    case "Escape":
      return escape();
    case "Delete":
    case "Backspace":
      return remove(open);
    case "F8":
      return nextProblem(open, event.shiftKey ? -1 : 1);
    case ".":
      if (open.canEdit) flushSync(() => useUi.setState({ more: true }));
      return open.canEdit;
    case "Enter":
      return enter(open, event.target);
    case "?":
      useUi.setState({ dialog: "shortcuts" });
      return true;
    case "ArrowLeft":
    case "ArrowRight":
    case "ArrowUp":
    case "ArrowDown":
      return neighbour(open, event.key);
    default:
      return false;
  }
}

/** The tool in hand sets its step down where there is room; without a tool the selected step is edited. */
function enter(open: OpenProgram, target: EventTarget | null): boolean {
  const { gesture, selected } = useUi.getState();
  if (target instanceof HTMLElement && target.closest("button, a, [role=treeitem]")) return false;
  if (open.canEdit && gesture.byKeyboard && askOf(gesture) === "floor") {
    createOnFloor(open, gesture, freeSpot(open, gesture.tool));
    return true;
  }
  if (selected.length !== 1) return false;
  useUi.setState({ inspector: true });
  requestAnimationFrame(() => window.document.querySelector<HTMLElement>("[data-form] :is(input, textarea)")?.focus());
  return true;
}

function escape(): boolean {
  const { gesture, fieldPick, into, selected } = useUi.getState();
  if (fieldPick) useUi.setState({ fieldPick: null });
  else if (gesture.tool !== "select") useUi.setState({ gesture: stepBack(gesture) });
  else if (into) useUi.setState({ into: null });
  else if (selected.length > 0) select([]);
  return true;
}

function remove(open: OpenProgram): boolean {
  if (!open.canEdit) return false;
  const count = removeSelected(open.document, open.apply);
  if (count > 0) say(open.t("removed", { count }), true);
  return count > 0;
}

function nextProblem({ diagnostics }: OpenProgram, by: 1 | -1): boolean {
  const steps = [...new Set(diagnostics.map((each) => each.step).filter(Boolean))];
  if (steps.length === 0) return true;
  const at = steps.indexOf(useUi.getState().selected.at(-1) ?? "");
  const next = steps[(at + by + steps.length) % steps.length];
  if (next) select([next]);
  showTab("problems");
  return true;
}

const NUDGES: Readonly<Record<string, Position>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

function moveKey(open: OpenProgram, event: KeyboardEvent): boolean {
  const direction = NUDGES[event.key];
  if (!direction || !open.canEdit) return false;
  const step = event.shiftKey ? 0.5 : 0.1;
  nudgeSelected(open.document, open.apply, [direction[0] * step, direction[1] * step]);
  return true;
}

/** The nearest step in the direction of the arrow. */
function neighbour({ scene }: OpenProgram, key: string): boolean {
  const from = scene.chips.get(useUi.getState().selected.at(-1) ?? "");
  const direction = NUDGES[key];
  if (!from || !direction) return false;
  let best: { id: string; far: number } | null = null;
  for (const chip of scene.chips.values()) {
    const [dx, dy] = [chip.at.x - from.at.x, from.at.y - chip.at.y];
    const ahead = dx * direction[0] + dy * direction[1];
    const aside = Math.abs(dx * direction[1]) + Math.abs(dy * direction[0]);
    const far = ahead + aside * 2;
    if (ahead > 4 && (!best || far < best.far)) best = { id: chip.id, far };
  }
  if (best) select([best.id]);
  return best !== null;
}

/** Alt+Shift+arrows in the step list: one place up or down. */
export function shiftInOrder(open: OpenProgram, step: string, by: -1 | 1): void {
  const decision = shiftStep(open.document, step, by);
  if ("edits" in decision) open.apply(decision.edits);
}
