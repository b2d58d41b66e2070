/** A step's dot dragged to another step: what it would say, and what it does when it is let go. */
import { START_ID } from "@/program/canvas/buildNodes";
import type { Decision } from "../edits/edits";
import { joinSteps, moveStep } from "../edits/joints";
import { ancestors, branchesOf, PROGRAM } from "@/program/document/tree";
import type { ProgramDocument } from "@/program/document/document";
import { branchWord } from "@/program/scene/links";
import type { OpenProgram } from "../state/context";
import { settle } from "../state/actions";
import { useGestures, type MenuItem } from "../state/gestures";

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
    label: branchWord(branch, step, t),
    run: (now) => settle(now, moveStep(now.document, to, { parent: from, branch }, null)),
  }));
  const behind: MenuItem = {
    id: "after",
    label: t("gesture.join.after"),
    run: (now) => settle(now, decideJoin(now.document, from, to)),
  };
  useGestures.setState({ menu: { at, label: t("gesture.join.which"), items: [...into, behind] } });
}
