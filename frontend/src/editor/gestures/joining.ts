/** A step's dot dragged to another step: what it would say, and what it does when it is let go. */
import type { Box } from "@/map/projection";
import type { PixelPoint } from "@/map/routePath";
import { START_ID } from "../canvas/buildNodes";
import type { Decision } from "../model/edits";
import { joinSteps, moveStep } from "../model/gestures";
import { ancestors, branchesOf, PROGRAM } from "../model/tree";
import type { ProgramDocument } from "../model/types";
import { grown } from "../scene/geometry";
import { branchWord } from "../scene/links";
import type { Scene } from "../scene/scene";
import type { OpenProgram } from "../state/context";
import { settle } from "./settle";
import { useGestures, type MenuItem } from "./store";

/** Pixels of the screen. */
const REACH = 24;

/** The step within reach of the pointer, the nearest of several. */
export function joinTarget(chips: Scene["chips"], from: string, point: PixelPoint, zoom: number): string | null {
  const near = [...chips.values()]
    .filter((chip) => chip.id !== from && inside(grown(chip.box, REACH / zoom), point))
    .map((chip) => ({ id: chip.id, far: Math.hypot(chip.at.x - point.x, chip.at.y - point.y) }));
  return near.sort((one, other) => one.far - other.far)[0]?.id ?? null;
}

/** Where a pointer or a finger was, pixels of the window. */
export function pointOf(event: MouseEvent | TouchEvent): { x: number; y: number } | null {
  const pointer = "changedTouches" in event ? event.changedTouches[0] : event;
  return pointer ? { x: pointer.clientX, y: pointer.clientY } : null;
}

function inside(box: Box, { x, y }: PixelPoint): boolean {
  return x > box.left && x < box.right && y > box.top && y < box.bottom;
}

export function decideJoin(document: ProgramDocument, from: string, to: string): Decision {
  return from === START_ID ? moveStep(document, to, PROGRAM, null) : joinSteps(document, from, to);
}

/** Out of a step with branches the arrow asks which one; out of any other the step just follows. */
export function joinByDot(open: OpenProgram, from: string, to: string, at: { x: number; y: number }): void {
  const { document, t } = open;
  const step = document.steps[from];
  const branches = step && !ancestors(document, from).includes(to) ? branchesOf(step) : [];
  if (!step || branches.length === 0) {
    settle(open, decideJoin(document, from, to));
    return;
  }
  const into = branches.map((branch): MenuItem => ({
    id: branch,
    label: branchWord(branch, step.kind, t),
    run: () => settle(open, moveStep(document, to, { parent: from, branch }, null)),
  }));
  const behind = {
    id: "after",
    label: t("gesture.join.after"),
    run: () => settle(open, decideJoin(document, from, to)),
  };
  useGestures.setState({ menu: { at, label: t("gesture.join.which"), items: [...into, behind] } });
}
