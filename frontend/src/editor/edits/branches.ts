/** Steps in and out of the frames around them, as pure decisions about the document. */
import type { Decision, Edit, StepPlace } from "./edits";
import { branchOf, moveSteps, neighbours, roomAt, type Goal } from "./joints";
import { branchesOf, readTree, EVENTS, type BranchRef } from "@/program/document/tree";
import type { ProgramDocument } from "@/program/document/document";

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
  const stays = (branch: string) => outside !== null && !isEvents(outside) && !["else", "catch"].includes(branch);
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
