/** A document read as a tree: which steps stand in which branch, and which are drafts. */
import { branchesOf, compareBytes, makeOutline } from "./outline";
import type { ProgramDocument } from "./document";

export interface BranchRef {
  readonly parent: string;
  readonly branch: string;
}

export interface ProgramTree {
  /** Steps of one branch in their order. */
  children(parent: string, branch: string): readonly string[];
  /** Steps that are joined to nothing; comments are none. */
  readonly drafts: readonly string[];
  /** The drafts with all that stands in them, as read from top to bottom. */
  readonly loose: readonly string[];
  /** Every step that is joined, parents before their children, as read from top to bottom. */
  readonly reading: readonly string[];
  /** How deep a step stands; 0 for the program's own and a function's own. */
  readonly depth: (step: string) => number;
}

export const PROGRAM: BranchRef = { parent: "program", branch: "body" };
/** Where the steps stand that begin when something happens, and no others. */
export const EVENTS: BranchRef = { parent: "program", branch: "events" };

export { branchesOf };

/** Documents never change in place: each is read once. */
const READ = new WeakMap<ProgramDocument, ProgramTree>();

export function readTree(document: ProgramDocument): ProgramTree {
  const known = READ.get(document);
  if (known) return known;
  const tree = treeOf(document);
  READ.set(document, tree);
  return tree;
}

function treeOf(document: ProgramDocument): ProgramTree {
  const outline = makeOutline(document);
  const depths = new Map<string, number>();
  const visit = (ids: readonly string[], depth: number, into: string[]) => {
    for (const id of ids) {
      if (depths.has(id)) continue;
      depths.set(id, depth);
      into.push(id);
      const step = document.steps[id];
      for (const inner of step ? branchesOf(step) : []) visit(outline.children(id, inner), depth + 1, into);
    }
    return into;
  };
  const reading = visit(outline.children(PROGRAM.parent, PROGRAM.branch), 0, []);
  visit(outline.children(EVENTS.parent, EVENTS.branch), 0, reading);
  for (const id of Object.keys(document.functions).sort(compareBytes)) visit(outline.children(id, "body"), 0, reading);
  const drafts = [...outline.drafts, ...outline.unknown];
  return {
    children: outline.children,
    drafts,
    loose: visit(drafts, 0, []),
    reading,
    depth: (step) => depths.get(step) ?? 0,
  };
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
