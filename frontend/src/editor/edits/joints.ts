/** How people change the order of steps, as pure decisions about the document. */
import type { ProgramDocument, Step, StepKind, Position } from "@/program/document/document";
import type { Decision, Edit, Refusal, StepPlace } from "./edits";
import { keysBetween } from "./order";
import { takes } from "@/program/document/outline";
import { standingAlone } from "@/program/document/called";
import {
  ancestors,
  EVENTS,
  outermost,
  PROGRAM,
  readTree,
  withDescendants,
  type BranchRef,
} from "@/program/document/tree";

export type MakeId = () => string;

/** A spot in the order: behind a step of a branch; null means at its beginning. */
export interface Goal {
  readonly branch: BranchRef;
  readonly after: string | null;
}

/** Where a new step goes: the branch of the selected step, at its end; else the program. */
export function branchForNew(document: ProgramDocument, selected: string | null): BranchRef {
  const place = selected ? document.steps[selected]?.place : null;
  return place && place[1] !== EVENTS.branch ? { parent: place[0], branch: place[1] } : PROGRAM;
}

export function endOfBranch(document: ProgramDocument, branch: BranchRef): Goal {
  return { branch, after: readTree(document).children(branch.parent, branch.branch).at(-1) ?? null };
}

/** Whether the document has the branch. */
export function hasBranch(document: ProgramDocument, { parent, branch }: BranchRef): boolean {
  return takes(document, parent, branch, "wait") || takes(document, parent, branch, "on_event");
}

/** Whether a goal that was chosen a while ago is one still: others may have taken it away, or what stood before it. */
export function stillThere(document: ProgramDocument, { branch, after }: Goal): boolean {
  if (!hasBranch(document, branch)) return false;
  return after === null || readTree(document).children(branch.parent, branch.branch).includes(after);
}

/** The branch that a step stands in, as the tree reads it; null for drafts. */
export function branchOf(document: ProgramDocument, id: string): BranchRef | null {
  const place = document.steps[id]?.place;
  if (!place || !readTree(document).children(place[0], place[1]).includes(id)) return null;
  return { parent: place[0], branch: place[1] };
}

export interface Room {
  readonly places: readonly StepPlace[];
  /** Neighbours with equal keys, left by people who appended at the same time, that make room. */
  readonly shifted: readonly Edit[];
}

/** Places in a row for so many steps at a goal, not counting those that leave their own. */
export function roomAt(
  document: ProgramDocument,
  { branch: { parent, branch }, after }: Goal,
  count: number,
  leaving: ReadonlySet<string> = new Set(),
): Room {
  const ids = readTree(document)
    .children(parent, branch)
    .filter((id) => !leaving.has(id));
  const order = (id: string | undefined) => (id === undefined ? null : (document.steps[id]?.place?.[2] ?? null));
  const first = after ? ids.indexOf(after) + 1 : 0;
  const before = order(ids[first - 1]);
  for (let tied = 0; ; tied += 1) {
    const next = order(ids[first + tied]);
    const keys = keysBetween(before, next, count + tied);
    if (!keys) continue;
    const places = keys.map((key): StepPlace => [parent, branch, key]);
    const shifted = places.slice(count).map((place, index): Edit => {
      return { do: "set_place", id: ids[first + index] ?? "", place };
    });
    return { places: places.slice(0, count), shifted };
  }
}

export interface NewStep {
  readonly id: string;
  readonly kind: StepKind;
  readonly pos: Position;
  readonly params: Readonly<Record<string, unknown>>;
}

/** A new step at a spot of the order, or at the end of a branch or of the events; a comment stands nowhere. */
export function addStep(document: ProgramDocument, where: BranchRef | Goal, fresh: NewStep): Edit[] {
  const { id, ...step } = fresh;
  if (fresh.kind === "comment") return [{ do: "add_step", id, step: { ...step, place: null } }];
  const goal = "after" in where ? where : endOfBranch(document, where);
  const room = roomAt(document, fresh.kind === "on_event" ? endOfBranch(document, EVENTS) : goal, 1);
  return [...room.shifted, { do: "add_step", id, step: { ...step, place: room.places[0] ?? null } }];
}

/** Put steps, with all inside them, one behind the other at a goal; refused where one would stand in itself. */
export function moveSteps(document: ProgramDocument, ids: readonly string[], goal: Goal): Decision {
  const refused = whyNotTo(document, ids, goal);
  if (refused) return { refused };
  const room = roomAt(document, goal, ids.length, new Set(ids));
  const moves = ids.map((id, index): Edit => ({ do: "set_place", id, place: room.places[index] ?? null }));
  return { edits: [...room.shifted, ...moves] };
}

/** Why steps cannot go to a goal; null where they can. */
export function whyNotTo(document: ProgramDocument, ids: readonly string[], goal: Goal): Refusal | null {
  const { parent } = goal.branch;
  if (ids.length === 0 || (goal.after !== null && ids.includes(goal.after))) return "nothing";
  const refused = ids.map((id) => whyNot(document.steps[id], goal.branch)).find((each) => each !== null);
  if (refused) return refused;
  if ([parent, ...ancestors(document, parent)].some((above) => ids.includes(above))) return "cycle";
  return stillThere(document, goal) ? null : "gone";
}

/** Events begin by themselves, comments are for people: neither stands among the steps. */
function whyNot(step: Step | undefined, branch: BranchRef): Refusal | null {
  if (!step || step.kind === "comment") return "nothing";
  const amongEvents = branch.parent === EVENTS.parent && branch.branch === EVENTS.branch;
  return (step.kind === "on_event") === amongEvents ? null : "event";
}

export function moveStep(document: ProgramDocument, id: string, branch: BranchRef, after: string | null): Decision {
  return moveSteps(document, [id], { branch, after });
}

/** Drag a step's dot to another step: that one follows it. From a draft: the draft goes before that one. */
export function joinSteps(document: ProgramDocument, from: string, to: string): Decision {
  if (from === to) return { refused: "nothing" };
  const [source, target] = [branchOf(document, from), branchOf(document, to)];
  if (source)
    return ancestors(document, from).includes(to) ? { refused: "cycle" } : moveStep(document, to, source, from);
  if (!target) return { refused: "drafts" };
  const siblings = readTree(document).children(target.parent, target.branch);
  return moveStep(document, from, target, siblings[siblings.indexOf(to) - 1] ?? null);
}

/** Remove the steps with all inside them; their neighbours join by themselves. */
export function deleteSteps(document: ProgramDocument, ids: readonly string[]): Edit[] {
  return [...withDescendants(document, ids)]
    .filter((id) => document.steps[id])
    .map((id) => ({ do: "remove_step", id }));
}

/** One place up or down among its neighbours. */
export function shiftStep(document: ProgramDocument, id: string, by: -1 | 1): Decision {
  const branch = branchOf(document, id);
  if (!branch) return { refused: "nothing" };
  const ids = readTree(document).children(branch.parent, branch.branch);
  const index = ids.indexOf(id);
  if (by === 1) {
    const next = ids[index + 1];
    return next ? moveStep(document, id, branch, next) : { refused: "nothing" };
  }
  return index > 0 ? moveStep(document, id, branch, ids[index - 2] ?? null) : { refused: "nothing" };
}

/** Take steps out of the order: drafts, kept with all inside them. */
export function disconnect(document: ProgramDocument, ids: readonly string[]): Decision {
  const joined = outermost(document, ids).filter((id) => branchOf(document, id));
  if (joined.length === 0) return { refused: "nothing" };
  return { edits: joined.map((id): Edit => ({ do: "set_place", id, place: null })) };
}

/** Join drafts at the end of the program, events among the events. */
export function joinDrafts(document: ProgramDocument, ids: readonly string[]): Decision {
  const { drafts } = readTree(document);
  const chosen = drafts.filter((id) => ids.includes(id));
  const isEvent = (id: string) => document.steps[id]?.kind === "on_event";
  const parts = [
    { branch: PROGRAM, ids: chosen.filter((id) => !isEvent(id)) },
    { branch: EVENTS, ids: chosen.filter(isEvent) },
  ].filter((part) => part.ids.length > 0);
  if (parts.length === 0) return { refused: "nothing" };
  const decisions = parts.map((part) => moveSteps(document, part.ids, endOfBranch(document, part.branch)));
  const refused = decisions.find((each) => "refused" in each);
  return refused ?? { edits: decisions.flatMap((each) => ("edits" in each ? each.edits : [])) };
}

/**
 * Steps that stand next to each other in one branch, in their order; null where they do not. Those in functions that
 * the others call do not count.
 */
export function neighbours(document: ProgramDocument, ids: readonly string[]): { steps: string[]; goal: Goal } | null {
  const chosen = new Set(standingAlone(document, ids));
  const [first] = chosen;
  const branch = first === undefined ? null : branchOf(document, first);
  if (!branch) return null;
  const siblings = readTree(document).children(branch.parent, branch.branch);
  const steps = siblings.filter((id) => chosen.has(id));
  const start = siblings.indexOf(steps[0] ?? "");
  const together = steps.length === chosen.size && steps.every((id, index) => siblings[start + index] === id);
  return together ? { steps, goal: { branch, after: siblings[start - 1] ?? null } } : null;
}
