/** What the toolbar, the keys and the menus do; each is one gesture and one entry to undo. */
import type { ProgramDocument, Position } from "@/program/document/document";
import { lastChosen } from "@/program/document/called";
import { EVENTS, type BranchRef } from "@/program/document/tree";
import { clip, type Clipping, paste } from "../edits/clipping";
import type { Decision, Edit } from "../edits/edits";
import {
  addStep,
  branchForNew,
  branchOf,
  deleteSteps,
  endOfBranch,
  type Goal,
  hasBranch,
  type NewStep,
  shiftStep,
  stillThere,
} from "../edits/joints";
import { moveTogether } from "../edits/arranging";
import { wrapIn } from "../edits/branches";
import type { OpenProgram } from "./context";
import { type Names, putEdits } from "./putting";
import { finish } from "./tool";
import { type NextPlace, say, select, useUi } from "./ui";

export type Apply = (edits: readonly Edit[]) => void;

/** Short enough to read in a file, long enough never to meet another. */
export function makeId(): string {
  return crypto.randomUUID().replaceAll("-", "").slice(0, 12);
}

/** The spot that was chosen for the next step, as long as nobody has taken its branch away. */
export function intoNow(document: ProgramDocument): NextPlace | null {
  const { into } = useUi.getState();
  return into && hasBranch(document, into.branch) ? into : null;
}

/** The branch that a new step goes into. */
export function branchNow(document: ProgramDocument): BranchRef {
  return intoNow(document)?.branch ?? branchForNew(document, lastChosen(document, useUi.getState().selected));
}

/** Behind the step that it was chosen for, while that stands there, else at the end of the branch. */
function placeNow(document: ProgramDocument): BranchRef | Goal {
  const branch = branchNow(document);
  const after = intoNow(document)?.after;
  return after !== undefined && stillThere(document, { branch, after }) ? { branch, after } : branch;
}

/** Make a step, select it, and put the tool away unless it is locked. */
export function createStep(document: ProgramDocument, apply: Apply, fresh: Omit<NewStep, "id">): string {
  const id = makeId();
  apply(addStep(document, placeNow(document), { ...fresh, id }));
  useUi.setState((ui) => ({ gesture: finish(ui.gesture) }));
  select([id]);
  useUi.setState({ fresh: id, inspector: true });
  return id;
}

export function removeSelected(document: ProgramDocument, apply: Apply, ids = useUi.getState().selected): number {
  const edits = deleteSteps(document, ids);
  if (edits.length === 0) return 0;
  apply(edits);
  select([]);
  return edits.length;
}

export function duplicateSelected(document: ProgramDocument, apply: Apply): void {
  const { selected } = useUi.getState();
  if (selected.length === 0) return;
  const { edits, added } = copiesOf(document, clip(document, selected));
  apply(edits);
  select(added);
}

/** Copies go behind the selected step, else to the end of the branch. */
function copiesOf(document: ProgramDocument, clipping: Clipping, here?: string): ReturnType<typeof paste> {
  return paste(document, clipping, goalNow(document), makeId, here);
}

/** Put steps from the clipboard into the program; devices that are not known here are asked for. */
export function pasteClipping(open: OpenProgram, clipping: Clipping, names: Names): void {
  putEdits(open, (document) => copiesOf(document, clipping, open.program.id), names);
}

function goalNow(document: ProgramDocument): Goal {
  const into = intoNow(document);
  const last = lastChosen(document, useUi.getState().selected);
  const branch = last === null ? null : branchOf(document, last);
  if (!into && branch && branch.branch !== EVENTS.branch) return { branch, after: last };
  return endOfBranch(document, into?.branch ?? branchForNew(document, last));
}

/** Metres; a frame takes along what stands in it. */
export function nudgeSelected(open: Pick<OpenProgram, "document" | "scene" | "apply">, by: Position): void {
  open.apply(moveTogether(open, useUi.getState().selected, by));
}

export function settle({ apply, t }: OpenProgram, decision: Decision): boolean {
  if ("edits" in decision) {
    apply(decision.edits);
    return true;
  }
  say(t(`refused.${decision.refused}`));
  return false;
}

/** Tell whether steps can be put into a time limit: neighbours in one branch. */
export function canLimit({ document, canEdit }: OpenProgram, ids: readonly string[]): boolean {
  return canEdit && "edits" in wrapIn(document, ids, { id: "", kind: "limit", params: {} });
}

/** Put steps into a time limit, and open it: its time is still to be entered. */
export function limitSteps(open: OpenProgram, ids: readonly string[]): void {
  const id = makeId();
  if (!settle(open, wrapIn(open.document, ids, { id, kind: "limit", params: {} }))) return;
  select([id]);
  useUi.setState({ fresh: id, inspector: true });
}

/** One place up or down in the order. */
export function shiftInOrder(
  { document, apply }: Pick<OpenProgram, "document" | "apply">,
  id: string,
  by: -1 | 1,
): void {
  const decision = shiftStep(document, id, by);
  if ("edits" in decision) apply(decision.edits);
}
