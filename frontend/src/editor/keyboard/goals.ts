/** Where a step can go in the order, as a list that is read from top to bottom; pure. */
import type { ProgramDocument } from "@/program/document/document";
import { branchesOf, EVENTS, PROGRAM, readTree } from "@/program/document/tree";
import { compareBytes } from "@/program/document/outline";
import type { Decision } from "../edits/edits";
import { branchOf, type Goal, moveSteps, whyNotTo } from "../edits/joints";

/** A spot in words: before or after a step, or inside one that holds others. */
export interface Spot extends Goal {
  readonly side: "before" | "after" | "inside" | "first";
  /** The step that the words are about; empty at the beginning of a program or function without steps. */
  readonly beside: string;
}

/** Every spot that the steps may go to, their own among them, in the order in which the program is read. */
export function spotsFor(document: ProgramDocument, ids: readonly string[]): readonly Spot[] {
  const tree = readTree(document);
  const moving = new Set(ids);
  const spots: Spot[] = [];
  const walk = (parent: string, branch: string, holder: string) => {
    const children = tree.children(parent, branch).filter((id) => !moving.has(id));
    const [first] = children;
    const into = { branch: { parent, branch }, after: null };
    if (first !== undefined) spots.push({ ...into, side: "before", beside: first });
    else spots.push({ ...into, side: holder ? "inside" : "first", beside: holder });
    for (const id of children) {
      const step = document.steps[id];
      for (const inner of step ? branchesOf(step) : []) walk(id, inner, id);
      spots.push({ branch: { parent, branch }, after: id, side: "after", beside: id });
    }
  };
  walk(PROGRAM.parent, PROGRAM.branch, "");
  walk(EVENTS.parent, EVENTS.branch, "");
  for (const id of Object.keys(document.functions).sort(compareBytes)) walk(id, "body", "");
  return spots.filter((spot) => whyNotTo(document, ids, spot) === null);
}

/** The spot where the first of the steps stands now; 0 for a draft, which stands nowhere. */
export function ownSpot(document: ProgramDocument, ids: readonly string[], spots: readonly Spot[]): number {
  const [first] = ids;
  const branch = first === undefined ? null : branchOf(document, first);
  if (first === undefined || !branch) return 0;
  const siblings = readTree(document).children(branch.parent, branch.branch);
  const before = siblings.slice(0, siblings.indexOf(first)).findLast((id) => !ids.includes(id)) ?? null;
  const found = spots.findIndex(
    (spot) => spot.branch.parent === branch.parent && spot.branch.branch === branch.branch && spot.after === before,
  );
  return Math.max(0, found);
}

/** The next one in a list that has hard ends: at an end it stays. */
export function beside(at: number, by: number, count: number): number {
  return Math.max(0, Math.min(count - 1, at + by));
}

/** What Enter does in the mode that moves. */
export function decideMove(document: ProgramDocument, ids: readonly string[], spot: Spot): Decision {
  return moveSteps(document, ids, spot);
}
