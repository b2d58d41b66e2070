/** Steps in and out of the frames around them, as pure decisions about the document. */
import type { Decision, Edit, StepPlace } from "./edits";
import { branchOf, moveSteps, neighbours, roomAt, type Goal } from "./joints";
import { isCatch } from "@/program/document/catches";
import { branchesOf, readTree, EVENTS, type BranchRef } from "@/program/document/tree";
import type { Position, ProgramDocument, Step, StepKind } from "@/program/document/document";
import { toCentimetre } from "./clipping";

/** Take neighbours out of their frame: they follow it. */
export function liftOut(document: ProgramDocument, ids: readonly string[]): Decision {
  const found = neighbours(document, ids);
  if (!found) return { refused: "one_branch" };
  const frame = found.goal.branch.parent;
  const outside = branchOf(document, frame);
  if (!outside || isEvents(outside)) return { refused: "not_inside" };
  return moveSteps(document, found.steps, { branch: outside, after: frame });
}

/** Put neighbours at the end of the frame that stands before them. */
export function moveIn(document: ProgramDocument, ids: readonly string[]): Decision {
  const found = neighbours(document, ids);
  if (!found) return { refused: "one_branch" };
  const frame = found.goal.after;
  const branch = frame === null ? null : firstBranch(document, frame);
  if (!branch) return { refused: "no_frame" };
  const after = readTree(document).children(branch.parent, branch.branch).at(-1) ?? null;
  return moveSteps(document, found.steps, { branch, after });
}

/** The branch of a frame that what is put into it goes to. */
export function firstBranch(document: ProgramDocument, id: string): BranchRef | null {
  const step = document.steps[id];
  const branch = step ? branchesOf(step)[0] : undefined;
  return branch === undefined ? null : { parent: id, branch };
}

/** Put neighbours into a new frame that stands where they stood. */
export function wrapIn(
  document: ProgramDocument,
  ids: readonly string[],
  fresh: { id: string; kind: StepKind; params: Step["params"] },
): Decision {
  const found = neighbours(document, ids);
  if (!found) return { refused: ids.length > 0 ? "one_branch" : "nothing" };
  if (isEvents(found.goal.branch)) return { refused: "event" };
  const { steps } = found;
  const body = { parent: fresh.id, branch: "body" };
  const { places } = roomAt(document, { branch: body, after: null }, steps.length);
  const frame: Step = {
    kind: fresh.kind,
    place: document.steps[steps[0] ?? ""]?.place,
    pos: above(document, steps),
    params: fresh.params,
  };
  return {
    edits: [
      { do: "add_step", id: fresh.id, step: frame },
      ...steps.map((id, index): Edit => ({ do: "set_place", id, place: places[index] ?? null })),
    ],
  };
}

/** Over the first of the steps, above all of them. */
function above(document: ProgramDocument, ids: readonly string[]): Position {
  const positions = ids.map((id) => document.steps[id]?.pos ?? [0, 0]);
  const left = positions[0]?.[0] ?? 0;
  return [left, toCentimetre(Math.max(...positions.map(([, y]) => y)) + 0.9)];
}

/** True and false change their steps. */
export function swapBranches(document: ProgramDocument, id: string): Decision {
  if (document.steps[id]?.kind !== "if") return { refused: "nothing" };
  const tree = readTree(document);
  const into = (branch: string, ids: readonly string[]) =>
    ids.map((step): Edit => {
      const place: StepPlace = [id, branch, document.steps[step]?.place?.[2] ?? ""];
      return { do: "set_place", id: step, place };
    });
  const edits = [...into("else", tree.children(id, "then")), ...into("then", tree.children(id, "else"))];
  return edits.length > 0 ? { edits } : { refused: "nothing" };
}

/** What always ran takes the frame's place; what ran only in another case becomes a draft. */
export function takeApart(document: ProgramDocument, id: string): Decision {
  const step = document.steps[id];
  const branches = step ? branchesOf(step) : [];
  if (branches.length === 0) return { refused: "nothing" };
  const tree = readTree(document);
  const outside = branchOf(document, id);
  const stays = (branch: string) => outside !== null && !isEvents(outside) && branch !== "else" && !isCatch(branch);
  const inside = (keep: boolean) =>
    branches.filter((branch) => stays(branch) === keep).flatMap((branch) => tree.children(id, branch));
  const goal: Goal | null = outside && { branch: outside, after: before(document, id, outside) };
  const room = goal && roomAt(document, goal, inside(true).length, new Set([id]));
  return {
    edits: [
      ...(room?.shifted ?? []),
      ...inside(true).map((each, index): Edit => ({ do: "set_place", id: each, place: room?.places[index] ?? null })),
      ...inside(false).map((each): Edit => ({ do: "set_place", id: each, place: null })),
      { do: "remove_step", id },
    ],
  };
}

function before(document: ProgramDocument, id: string, branch: BranchRef): string | null {
  const siblings = readTree(document).children(branch.parent, branch.branch);
  return siblings[siblings.indexOf(id) - 1] ?? null;
}

function isEvents(branch: BranchRef): boolean {
  return branch.parent === EVENTS.parent && branch.branch === EVENTS.branch;
}
