/** A document read as a tree: which steps stand in which branch, and which are drafts. */
import type { ProgramDocument, Step } from "./types";

export interface BranchRef {
  readonly parent: string;
  readonly branch: string;
}

export interface ProgramTree {
  /** Steps of one branch in their order. */
  children(parent: string, branch: string): readonly string[];
  /** Steps that are joined to nothing; comments are none. */
  readonly drafts: readonly string[];
  /** Every step that is joined, parents before their children, as read from top to bottom. */
  readonly reading: readonly string[];
  /** How deep a step stands; 0 for the program's own and a function's own. */
  depth(step: string): number;
}

export const PROGRAM: BranchRef = { parent: "program", branch: "body" };
/** Where the steps stand that begin when something happens, and no others. */
export const EVENTS: BranchRef = { parent: "program", branch: "events" };

/** The branches that a step of this kind has, in the order in which they are read. */
export function branchesOf(step: Step): readonly string[] {
  switch (step.kind) {
    case "if":
      return ["then", "else"];
    case "while":
    case "repeat":
    case "for_each":
    case "on_event":
      return ["body"];
    case "try":
      return ["body", "catch", "finally"];
    case "parallel": {
      const names = step.params.branches;
      return Array.isArray(names) && names.length > 0 ? names.map(String) : ["a", "b"];
    }
    default:
      return [];
  }
}

export function readTree(document: ProgramDocument): ProgramTree {
  const branches = sortIntoBranches(document);
  const reading: string[] = [];
  const depths = new Map<string, number>();
  const visit = (parent: string, branch: string, depth: number) => {
    for (const id of branches.get(keyOf(parent, branch)) ?? []) {
      if (depths.has(id)) continue;
      depths.set(id, depth);
      reading.push(id);
      const step = document.steps[id];
      for (const inner of step ? branchesOf(step) : []) visit(id, inner, depth + 1);
    }
  };
  visit(PROGRAM.parent, PROGRAM.branch, 0);
  visit(EVENTS.parent, EVENTS.branch, 0);
  for (const id of Object.keys(document.functions).sort()) visit(id, "body", 0);
  return {
    children: (parent, branch) => branches.get(keyOf(parent, branch)) ?? [],
    drafts: Object.keys(document.steps)
      .filter((id) => !depths.has(id) && document.steps[id]?.kind !== "comment")
      .sort(),
    reading,
    depth: (step) => depths.get(step) ?? 0,
  };
}

function keyOf(parent: string, branch: string): string {
  return `${parent}\n${branch}`;
}

function sortIntoBranches(document: ProgramDocument): Map<string, string[]> {
  const branches = new Map<string, string[]>();
  for (const [id, step] of Object.entries(document.steps)) {
    if (!step.place || !mayStand(step)) continue;
    const key = keyOf(step.place[0], step.place[1]);
    branches.set(key, [...(branches.get(key) ?? []), id]);
  }
  const order = (id: string) => document.steps[id]?.place?.[2] ?? "";
  const compare = (a: string, b: string) => (a < b ? -1 : a > b ? 1 : 0);
  for (const ids of branches.values())
    ids.sort((one, other) => compare(order(one), order(other)) || compare(one, other));
  return branches;
}

/** Comments stand nowhere in the program; events stand beside it, and nothing else does. */
function mayStand(step: Step): boolean {
  const amongEvents = step.place?.[0] === EVENTS.parent && step.place[1] === EVENTS.branch;
  return step.kind !== "comment" && amongEvents === (step.kind === "on_event");
}

/** The step and everything inside it. */
export function withDescendants(document: ProgramDocument, ids: Iterable<string>): Set<string> {
  const all = new Set(ids);
  for (let before = -1; before !== all.size;) {
    before = all.size;
    for (const [id, step] of Object.entries(document.steps)) if (step.place && all.has(step.place[0])) all.add(id);
  }
  return all;
}

/** The chain of parents above a step, the nearest first; ends at the program, a function or a gap. */
export function ancestors(document: ProgramDocument, id: string): readonly string[] {
  const chain: string[] = [];
  for (let at = document.steps[id]?.place?.[0]; at && !chain.includes(at); at = document.steps[at]?.place?.[0])
    chain.push(at);
  return chain;
}

/** Leave out those that stand inside another one of them. */
export function outermost(document: ProgramDocument, ids: readonly string[]): string[] {
  const chosen = new Set(ids);
  return ids.filter((id) => !ancestors(document, id).some((above) => chosen.has(above)));
}
