/** Steps cut out of a program, as data that also fits the clipboard, and put into the same or another one. */
import type { Edit, StepPlace } from "./edits";
import {
  type Position,
  type FunctionDefinition,
  type ProgramDocument,
  type Role,
  type Step,
} from "@/program/document/document";
import { endOfBranch, roomAt, type Goal, type MakeId } from "./joints";
import { roleOfStep } from "@/program/operation";
import { EVENTS, outermost, readTree, withDescendants, type ProgramTree } from "@/program/document/tree";

/** Steps with all inside them, the functions they call with their bodies, and the roles they name. */
export interface Clipping {
  readonly steps: Readonly<Record<string, Step>>;
  /** Those that stand in no other one, in their order. */
  readonly outer: readonly string[];
  readonly functions: Readonly<Record<string, FunctionDefinition>>;
  readonly bodies: Readonly<Record<string, Step>>;
  readonly roles: Readonly<Record<string, Role>>;
}

const MARK = "vipo steps 2";

export function clip(document: ProgramDocument, ids: readonly string[]): Clipping {
  const outer = sortByReading(readTree(document), outermost(document, ids));
  const steps = pickSteps(document, withDescendants(document, outer));
  const functions = calledBy(document, Object.values(steps));
  const bodies = pickSteps(document, bodiesOf(document, functions));
  const named = [...Object.values(steps), ...Object.values(bodies)].map((step) => roleOfStep(step) ?? "");
  const roles = Object.fromEntries(Object.entries(document.roles).filter(([id]) => named.includes(id)));
  const definitions = Object.entries(document.functions).filter(([id]) => functions.has(id));
  return { steps, outer, functions: Object.fromEntries(definitions), bodies, roles };
}

export function clippingToText(clipping: Clipping): string {
  return JSON.stringify({ type: MARK, ...clipping });
}

/** What `clippingToText` gave; null for any other text. */
export function clippingFromText(text: string): Clipping | null {
  if (!text.includes(MARK)) return null;
  try {
    const { type, steps, outer, functions, bodies, roles } = JSON.parse(text) as { type?: string } & Clipping;
    const whole = [steps, functions, bodies, roles].every((part) => typeof part === "object" && part);
    const sound = type === MARK && whole && Array.isArray(outer) && outer.every((id: string) => isStep(steps[id]));
    const all = sound && [...Object.values(steps), ...Object.values(bodies)].every(isStep);
    return all ? { steps, outer, functions, bodies, roles } : null;
  } catch {
    return null;
  }
}

function isStep(value: unknown): boolean {
  const step = value as Step | null | undefined;
  return typeof step?.kind === "string" && typeof step.params === "object" && step.params !== null;
}

/** The functions that steps call, and those that these call. */
function calledBy(document: ProgramDocument, steps: readonly Step[]): Set<string> {
  const found = new Set<string>();
  let left = [...steps];
  while (left.length > 0) {
    const names = left.filter((step) => step.kind === "call").map((step) => String(step.params.function));
    const fresh = names.filter((id) => id in document.functions && !found.has(id));
    for (const id of fresh) found.add(id);
    left = Object.values(pickSteps(document, bodiesOf(document, fresh)));
  }
  return found;
}

function bodiesOf(document: ProgramDocument, functions: Iterable<string>): Set<string> {
  const tree = readTree(document);
  const tops = [...functions].flatMap((id) => tree.children(id, "body"));
  return withDescendants(document, tops);
}

function pickSteps(document: ProgramDocument, ids: Iterable<string>): Record<string, Step> {
  return Object.fromEntries(
    [...ids].flatMap((id) => {
      const step = document.steps[id];
      return step ? [[id, step] as const] : [];
    }),
  );
}

export function sortByReading(tree: ProgramTree, ids: readonly string[]): string[] {
  const order = new Map([...tree.reading, ...tree.loose].map((id, index) => [id, index]));
  return [...ids].sort((one, other) => (order.get(one) ?? 0) - (order.get(other) ?? 0));
}

/** Put copies with ids of their own at a goal, a little beside the originals. */
export function paste(
  document: ProgramDocument,
  clipping: Clipping,
  goal: Goal,
  makeId: MakeId,
  offset: Position = [0.5, -0.5],
): { edits: Edit[]; added: string[] } {
  const fresh = new Map(Object.keys(clipping.steps).map((id) => [id, makeId()]));
  const copies = Object.entries(clipping.steps).map(([id, step]): Edit => {
    const inner = clipping.outer.includes(id) ? null : placeInCopy(step, fresh);
    return { do: "add_step", id: fresh.get(id) ?? id, step: moved({ ...step, place: inner }, offset) };
  });
  const among = (id: string) => fresh.get(id) ?? id;
  const places = [
    ...placesFor(document, clipping, goal, among, (kind) => kind !== "comment" && kind !== "on_event"),
    ...placesFor(document, clipping, endOfBranch(document, EVENTS), among, (kind) => kind === "on_event"),
  ];
  const edits = [...missingRoles(document, clipping), ...missingFunctions(document, clipping, makeId), ...copies];
  return { edits: [...edits, ...places], added: clipping.outer.map((id) => fresh.get(id) ?? id) };
}

function placeInCopy(step: Step, fresh: ReadonlyMap<string, string>): StepPlace | null {
  const parent = fresh.get(step.place?.[0] ?? "");
  return step.place && parent !== undefined ? [parent, step.place[1], step.place[2]] : null;
}

function placesFor(
  document: ProgramDocument,
  clipping: Clipping,
  goal: Goal,
  copyOf: (id: string) => string,
  fits: (kind: string) => boolean,
): readonly Edit[] {
  const ids = clipping.outer.filter((id) => fits(clipping.steps[id]?.kind ?? "comment"));
  const room = roomAt(document, goal, ids.length);
  return [
    ...room.shifted,
    ...ids.map((id, index): Edit => ({ do: "set_place", id: copyOf(id), place: room.places[index] ?? null })),
  ];
}

function missingRoles(document: ProgramDocument, clipping: Clipping): Edit[] {
  const missing = Object.entries(clipping.roles).filter(([id]) => !(id in document.roles));
  return missing.map(([id, value]) => ({ do: "set_role", id, value }));
}

/** Functions that the document does not have come with their bodies. */
function missingFunctions(document: ProgramDocument, clipping: Clipping, makeId: MakeId): Edit[] {
  const missing = Object.entries(clipping.functions).filter(([id]) => !(id in document.functions));
  const kept = new Map(missing.map(([id]) => [id, id]));
  const fresh = new Map([...kept, ...Object.keys(clipping.bodies).map((id) => [id, makeId()] as const)]);
  const bodies = Object.entries(clipping.bodies).flatMap(([id, step]): Edit[] => {
    const belongs = topOf(clipping.bodies, step);
    return kept.has(belongs)
      ? [{ do: "add_step", id: fresh.get(id) ?? id, step: { ...step, place: placeInCopy(step, fresh) } }]
      : [];
  });
  return [...missing.map(([id, value]): Edit => ({ do: "set_function", id, value })), ...bodies];
}

/** The function that a step of a body stands in. */
function topOf(bodies: Clipping["bodies"], step: Step): string {
  let above = step.place?.[0] ?? "";
  for (const seen = new Set<string>(); above in bodies && !seen.has(above);) {
    seen.add(above);
    above = bodies[above]?.place?.[0] ?? "";
  }
  return above;
}

export function moved(step: Step, [dx, dy]: Position): Step {
  const [x, y] = step.pos ?? [0, 0];
  return { ...step, pos: [toCentimetre(x + dx), toCentimetre(y + dy)] };
}

export function toCentimetre(value: number): number {
  return Math.round(value * 100) / 100 + 0;
}
