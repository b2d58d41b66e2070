/** What people do on the map and in the step list, as pure decisions about the document. */
import type { FunctionDefinition, ProgramDocument, Step, StepKind } from "./types";
import type { Decision, Edit, Position, StepPlace } from "./edits";
import { keyBetween } from "./order";
import { ancestors, outermost, PROGRAM, readTree, withDescendants, type BranchRef, type ProgramTree } from "./tree";

export type MakeId = () => string;

/** Where a new step goes: the branch of the selected step, at its end; else the program. */
export function branchForNew(document: ProgramDocument, selected: string | null): BranchRef {
  const place = selected ? document.steps[selected]?.place : null;
  return place ? { parent: place[0], branch: place[1] } : PROGRAM;
}

export function placeAtEnd(document: ProgramDocument, branch: BranchRef): StepPlace {
  return placeAfter(document, branch, readTree(document).children(branch.parent, branch.branch).at(-1) ?? null);
}

/** The place right behind `after` in the branch; null means at its beginning. */
export function placeAfter(
  document: ProgramDocument,
  branch: BranchRef,
  after: string | null,
  ignore: ReadonlySet<string> = new Set(),
): StepPlace {
  const tree = readTree(document);
  const ids = tree.children(branch.parent, branch.branch).filter((id) => !ignore.has(id));
  const order = (id: string | undefined) => (id ? (document.steps[id]?.place?.[2] ?? null) : null);
  const before = after ? order(after) : null;
  const behind = ids.slice(after ? ids.indexOf(after) + 1 : 0).find((id) => (order(id) ?? "") > (before ?? ""));
  return [branch.parent, branch.branch, keyBetween(before, order(behind))];
}

export interface NewStep {
  readonly id: string;
  readonly kind: StepKind;
  readonly pos: Position;
  readonly params: Readonly<Record<string, unknown>>;
}

export function addStep(document: ProgramDocument, branch: BranchRef, fresh: NewStep): Edit[] {
  const step: Step = {
    kind: fresh.kind,
    place: placeAtEnd(document, branch),
    pos: fresh.pos,
    params: fresh.params,
  };
  return [{ do: "add_step", id: fresh.id, step }];
}

/** Put a step, with all inside it, behind `after` in a branch; refused where it would stand in itself. */
export function moveStep(document: ProgramDocument, id: string, branch: BranchRef, after: string | null): Decision {
  if (!document.steps[id] || after === id) return { refused: "nothing" };
  if (branch.parent === id || ancestors(document, branch.parent).includes(id)) return { refused: "cycle" };
  return { edits: [{ do: "set_place", id, place: placeAfter(document, branch, after, new Set([id])) }] };
}

/** Drag a step's dot to another step: that one follows it. */
export function joinSteps(document: ProgramDocument, from: string, to: string): Decision {
  const place = document.steps[from]?.place;
  if (from === to || !place) return { refused: "nothing" };
  return ancestors(document, from).includes(to)
    ? { refused: "cycle" }
    : moveStep(document, to, { parent: place[0], branch: place[1] }, from);
}

/** Remove the steps with all inside them; their neighbours join by themselves. */
export function deleteSteps(document: ProgramDocument, ids: readonly string[]): Edit[] {
  return [...withDescendants(document, ids)]
    .filter((id) => document.steps[id])
    .map((id) => ({ do: "remove_step", id }));
}

/** One place up or down among its neighbours. */
export function shiftStep(document: ProgramDocument, id: string, by: -1 | 1): Decision {
  const place = document.steps[id]?.place;
  if (!place) return { refused: "nothing" };
  const branch = { parent: place[0], branch: place[1] };
  const ids = readTree(document).children(branch.parent, branch.branch);
  const index = ids.indexOf(id);
  if (by === 1) {
    const next = ids[index + 1];
    return next ? moveStep(document, id, branch, next) : { refused: "nothing" };
  }
  return index > 0 ? moveStep(document, id, branch, ids[index - 2] ?? null) : { refused: "nothing" };
}

/** Make a function of the steps and call it where they stood; they must be neighbours in one branch. */
export function wrapInFunction(
  document: ProgramDocument,
  ids: readonly string[],
  fresh: { functionId: string; callId: string; name: string },
): Decision {
  const tree = readTree(document);
  const chosen = sortByReading(tree, outermost(document, ids));
  const first = chosen[0] ? document.steps[chosen[0]] : undefined;
  if (!first?.place) return { refused: "nothing" };
  const [parent, branch] = first.place;
  const same = chosen.every((id) => {
    const place = document.steps[id]?.place;
    return place?.[0] === parent && place[1] === branch;
  });
  const siblings = tree.children(parent, branch);
  const start = siblings.indexOf(chosen[0] ?? "");
  const together = chosen.every((id, index) => siblings[start + index] === id);
  if (!same || !together) return { refused: "one_branch" };
  return { edits: wrapEdits(document, chosen, first, fresh) };
}

function wrapEdits(
  document: ProgramDocument,
  chosen: readonly string[],
  first: Step,
  fresh: { functionId: string; callId: string; name: string },
): Edit[] {
  const call: Step = {
    kind: "call",
    place: first.place,
    pos: middle(document, chosen),
    params: { function: fresh.functionId, args: {} },
  };
  return [
    { do: "set_function", id: fresh.functionId, value: { name: fresh.name, parameters: [] } },
    ...chosen.map((id): Edit => {
      const order = document.steps[id]?.place?.[2] ?? "V";
      return { do: "set_place", id, place: [fresh.functionId, "body", order] };
    }),
    { do: "add_step", id: fresh.callId, step: call },
  ];
}

function middle(document: ProgramDocument, ids: readonly string[]): Position {
  const positions = ids.map((id) => document.steps[id]?.pos ?? [0, 0]);
  const mean = (axis: 0 | 1) =>
    Math.round((positions.reduce((sum, pos) => sum + pos[axis], 0) / Math.max(1, positions.length)) * 100) / 100;
  return [mean(0), Math.round((mean(1) - 0.8) * 100) / 100];
}

function sortByReading(tree: ProgramTree, ids: readonly string[]): string[] {
  return [...ids].sort((one, other) => tree.reading.indexOf(one) - tree.reading.indexOf(other));
}

/** Steps taken out of a document, with all inside them and the functions they call. */
export interface Clipping {
  readonly steps: Readonly<Record<string, Step>>;
  readonly outer: readonly string[];
  readonly functions: Readonly<Record<string, FunctionDefinition>>;
}

export function clip(document: ProgramDocument, ids: readonly string[]): Clipping {
  const outer = sortByReading(readTree(document), outermost(document, ids));
  const steps = pickSteps(document, withDescendants(document, outer));
  return { steps, outer, functions: document.functions };
}

function pickSteps(document: ProgramDocument, ids: Iterable<string>): Record<string, Step> {
  return Object.fromEntries(
    [...ids].flatMap((id) => {
      const step = document.steps[id];
      return step ? [[id, step] as const] : [];
    }),
  );
}

/** Put copies with ids of their own at the end of a branch, a little beside the originals. */
export function paste(
  document: ProgramDocument,
  clipping: Clipping,
  branch: BranchRef,
  makeId: MakeId,
  offset: Position = [0.5, -0.5],
): { edits: Edit[]; added: string[] } {
  const fresh = new Map(Object.keys(clipping.steps).map((id) => [id, makeId()]));
  let last = placeAtEnd(document, branch);
  const edits: Edit[] = [];
  for (const [id, step] of Object.entries(clipping.steps)) {
    if (clipping.outer.includes(id)) continue;
    const parent = fresh.get(step.place?.[0] ?? "");
    const place: StepPlace | null = step.place && parent ? [parent, step.place[1], step.place[2]] : null;
    edits.push({ do: "add_step", id: fresh.get(id) ?? id, step: moved({ ...step, place }, offset) });
  }
  for (const id of clipping.outer) {
    const step = clipping.steps[id];
    if (!step) continue;
    edits.push({ do: "add_step", id: fresh.get(id) ?? id, step: moved({ ...step, place: last }, offset) });
    last = [last[0], last[1], keyBetween(last[2], null)];
  }
  const missing = Object.entries(clipping.functions).filter(
    ([id]) =>
      !document.functions[id] && edits.some((edit) => edit.do === "add_step" && edit.step.params.function === id),
  );
  for (const [id, value] of missing) edits.push({ do: "set_function", id, value });
  return { edits, added: clipping.outer.map((id) => fresh.get(id) ?? id) };
}

function moved(step: Step, offset: Position): Step {
  const pos = step.pos ?? [0, 0];
  const shift = (axis: 0 | 1) => Math.round((pos[axis] + offset[axis]) * 100) / 100;
  return { ...step, pos: [shift(0), shift(1)] };
}
