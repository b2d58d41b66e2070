/** Where each step stands, whatever people or merges have left: the rules of docs/language/README.md, as in Python. */
import { catchesOf } from "./catches";
import { isStepKind, kindOf } from "../kinds";
import type { ProgramDocument, Step } from "./document";

const DEEPEST_STEP = 30;
const MOST_BRANCHES = 26;

export type GoodPlace = readonly [parent: string, branch: string, order: string];

export interface Outline {
  /** Steps of one branch in their order. */
  readonly children: (parent: string, branch: string) => readonly string[];
  /** Steps that stand nowhere, sorted; what stands in them is not listed. Comments are none. */
  readonly drafts: readonly string[];
  /** Steps of kinds that this version does not know, sorted. */
  readonly unknown: readonly string[];
}

/** The branches that a step of this kind has. */
export function branchesOf(step: Step): readonly string[] {
  if (step.kind === "parallel") return parallelBranches(step.params.branches);
  if (step.kind === "try") return ["body", ...catchesOf(step.params), "finally"];
  return kindOf(step.kind).branches ?? [];
}

function parallelBranches(value: unknown): readonly string[] {
  const named = Array.isArray(value) ? value.filter((name) => typeof name === "string" && /^[a-z]$/.test(name)) : [];
  const names = [...new Set(named as string[])].slice(0, MOST_BRANCHES);
  return names.length > 0 ? names : ["a", "b"];
}

export function makeOutline(document: ProgramDocument): Outline {
  const known = Object.keys(document.steps).filter((id) => id && isStepKind(document.steps[id]?.kind ?? ""));
  const placed = new Map<string, GoodPlace>();
  for (const id of known) {
    const place = placeOf(document, id);
    if (place) placed.set(id, place);
  }
  for (const id of circleBreakers(placed)) placed.delete(id);
  for (const id of tooDeep(sortIntoBranches(placed), Object.keys(document.functions))) placed.delete(id);
  const branches = sortIntoBranches(placed);
  return {
    children: (parent, branch) => branches.get(keyOf(parent, branch)) ?? [],
    drafts: known.filter((id) => !placed.has(id) && document.steps[id]?.kind !== "comment").sort(compareBytes),
    unknown: Object.keys(document.steps)
      .filter((id) => id && !isStepKind(document.steps[id]?.kind ?? ""))
      .sort(compareBytes),
  };
}

/** A step's place where it names a branch that is there and that takes such a step. */
function placeOf(document: ProgramDocument, id: string): GoodPlace | null {
  const step = document.steps[id];
  const place: unknown = step?.place;
  if (!step || step.kind === "comment" || !Array.isArray(place) || place.length !== 3) return null;
  if (!place.every((part) => typeof part === "string")) return null;
  const [parent, branch, order] = place as [string, string, string];
  return takes(document, parent, branch, step.kind) ? [parent, branch, order] : null;
}

/** Whether a branch is there that takes a step of this kind. */
export function takes(document: ProgramDocument, parent: string, branch: string, kind: string): boolean {
  const above = Object.hasOwn(document.steps, parent) ? document.steps[parent] : undefined;
  if (above && isStepKind(above.kind)) return kind !== "on_event" && branchesOf(above).includes(branch);
  if (kind === "on_event") return parent === "program" && branch === "events";
  return branch === "body" && (parent === "program" || Object.hasOwn(document.functions, parent));
}

/** The step with the smallest id of each circle of parents. */
function circleBreakers(places: ReadonlyMap<string, GoodPlace>): string[] {
  const settled = new Set<string>();
  const breakers: string[] = [];
  for (const id of places.keys()) {
    const walk: string[] = [];
    let here = id;
    for (let place = places.get(here); place && !settled.has(here); place = places.get(here)) {
      if (walk.includes(here)) break;
      walk.push(here);
      here = place[0];
    }
    const circle = walk.slice(walk.indexOf(here)).sort(compareBytes);
    if (walk.includes(here) && circle[0] !== undefined) breakers.push(circle[0]);
    for (const step of walk) settled.add(step);
  }
  return breakers;
}

function sortIntoBranches(places: ReadonlyMap<string, GoodPlace>): Map<string, string[]> {
  const branches = new Map<string, string[]>();
  for (const [id, [parent, branch]] of places) {
    const key = keyOf(parent, branch);
    const ids = branches.get(key);
    if (ids) ids.push(id);
    else branches.set(key, [id]);
  }
  const order = (id: string) => places.get(id)?.[2] ?? "";
  for (const ids of branches.values())
    ids.sort((one, other) => compareBytes(order(one), order(other)) || compareBytes(one, other));
  return branches;
}

/** The steps at the first level that is too deep to be read. */
function tooDeep(branches: ReadonlyMap<string, readonly string[]>, functions: readonly string[]): readonly string[] {
  const byParent = new Map<string, string[]>();
  for (const [key, ids] of branches) {
    const parent = key.slice(0, key.lastIndexOf("\n"));
    byParent.set(parent, [...(byParent.get(parent) ?? []), ...ids]);
  }
  const inside = (parents: readonly string[]) => parents.flatMap((parent) => byParent.get(parent) ?? []);
  let level = inside(["program", ...functions]);
  for (let depth = 0; depth < DEEPEST_STEP; depth += 1) level = inside(level);
  return level;
}

function keyOf(parent: string, branch: string): string {
  return `${parent}\n${branch}`;
}

/** As the bytes of UTF-8 sort: JavaScript's own order puts rare signs (above U+FFFF) before some common ones. */
export function compareBytes(one: string, other: string): number {
  const shorter = Math.min(one.length, other.length);
  for (let index = 0; index < shorter; index += 1) {
    const [a, b] = [one.charCodeAt(index), other.charCodeAt(index)];
    if (a !== b) return rank(a) - rank(b);
  }
  return one.length - other.length;
}

function rank(unit: number): number {
  if (unit < 0xd800) return unit;
  return unit < 0xe000 ? unit + 0x2000 : unit - 0x800;
}
