/** Dotted links: what comes next, and the branches with their words. */
import { pathLength, type PixelPoint, pointAlong } from "@/map/plane/paths";
import type { Box } from "@/map/plane/projection";
import { catchesOf, isCatch } from "../document/catches";
import type { ProgramDocument, Step } from "../document/document";
import { branchesOf, type BranchRef, PROGRAM, type ProgramTree } from "../document/tree";
import { isFramed } from "../kinds";
import type { Surroundings } from "../surroundings";
import { takenBy } from "../words/catchWords";
import type { Translate } from "../words/stepWords";
import type { Chip } from "./chips";
import type { Frame } from "./frames";
import { boxAt, elbow, elbowSideways } from "./geometry";
import { endOf, functionOf, startOf } from "./stepPaths";

export interface Link {
  readonly id: string;
  readonly points: readonly PixelPoint[];
  /** What the arrow says; null for a plain "then". */
  readonly word: string | null;
  readonly tone: "then" | "branch" | "catch";
  /** Where a step that is dropped on the link goes. */
  readonly into: BranchRef;
  readonly after: string | null;
  /** The step that the link leads to; null for the stub of an empty branch. */
  readonly to: string | null;
  readonly from: string | null;
  /** How many rows lower its word stands: those of several catches would else lie on each other. */
  readonly row?: number;
}

export interface LinkInput {
  readonly document: ProgramDocument;
  readonly tree: ProgramTree;
  readonly chips: ReadonlyMap<string, Chip>;
  readonly frames: ReadonlyMap<string, Frame>;
  readonly start: PixelPoint;
  readonly surroundings: Surroundings;
  readonly t: Translate;
}

export function linksOf(input: LinkInput): Link[] {
  const { document, tree, chips } = input;
  const links = [startLink(input), ...thenLinks(input, PROGRAM)];
  for (const id of Object.keys(document.functions)) links.push(...thenLinks(input, { parent: id, branch: "body" }));
  for (const id of chips.keys()) {
    const step = document.steps[id];
    for (const branch of step ? branchesOf(step) : []) {
      const into = { parent: id, branch };
      links.push(branchLink(input, into, tree.children(id, branch)[0] ?? null), ...thenLinks(input, into));
    }
  }
  return links.filter((link) => link !== null);
}

function startLink(input: LinkInput): Link | null {
  const first = input.tree.children(PROGRAM.parent, PROGRAM.branch)[0];
  const box = first ? (firstPlace(input, first) ?? boxOf(input, first)) : null;
  if (!first || !box) return null;
  return {
    id: "start",
    points: elbow(boxAt(input.start, 78, 30), box),
    word: null,
    tone: "branch",
    into: PROGRAM,
    after: null,
    to: first,
    from: null,
  };
}

/** A program that begins at a machine is entered there: source, chip, target. */
function firstPlace({ document, surroundings }: LinkInput, first: string): Box | null {
  const step = document.steps[first];
  return step ? (startOf(step, document, surroundings, null)?.box ?? null) : null;
}

/** A step that begins where the one before it ends follows without an arrow: its number says so. */
function thenLinks(input: LinkInput, into: BranchRef): (Link | null)[] {
  const ids = input.tree.children(into.parent, into.branch);
  const frame = input.frames.get(into.parent);
  return ids.slice(1).map((to, index) => {
    const from = ids[index] ?? "";
    const [a, b] = [boxOf(input, from), boxOf(input, to)];
    const together = into.branch === "body" && frame?.holds.has(from) && frame.holds.has(to);
    if (!a || !b || together || isContinuous(input, from, to)) return null;
    return { id: `${from}>${to}`, points: elbow(a, b), word: null, tone: "then", into, after: from, to, from };
  });
}

function isContinuous({ document, surroundings }: LinkInput, from: string, to: string): boolean {
  const [a, b] = [document.steps[from], document.steps[to]];
  if (!a || !b) return false;
  const scope = functionOf(document, from);
  const end = endOf(a, document, surroundings, scope);
  const start = b.kind === "move" ? end : startOf(b, document, surroundings, scope);
  return end !== null && start !== null && end.at.x === start.at.x && end.at.y === start.at.y;
}

function branchLink(input: LinkInput, into: BranchRef, first: string | null): Link | null {
  const { document, frames, t } = input;
  const from = boxOf(input, into.parent);
  const kind = document.steps[into.parent]?.kind ?? "";
  const bodyInside = isFramed(kind) && into.branch === "body";
  if (!from || (bodyInside && (!first || frames.get(into.parent)?.holds.has(first)))) return null;
  if (!first && !offersBranch(document, into)) return null;
  const target = first ? boxOf(input, first) : null;
  const step = document.steps[into.parent];
  const tone = isCatch(into.branch) ? "catch" : "branch";
  const exit = exitOf(input, into, from);
  const row =
    step?.kind === "try" && catchesOf(step.params).length > 1
      ? drawnExits(input, into, step).indexOf(into.branch) % ROWS
      : 0;
  const points = target ? branchWay(into, exit, target) : stub(exit, into.branch, row);
  return {
    id: `${into.parent}/${into.branch}`,
    points,
    word: (step && (takenBy(into.branch, step, t) ?? branchWord(into.branch, step, t))) || null,
    tone,
    into,
    after: null,
    to: first,
    from: into.parent,
    row,
  };
}

/** An empty branch is drawn while it is offered: a Try may catch nothing, or have nothing to do at last. */
export function offersBranch(document: ProgramDocument, { parent, branch }: BranchRef): boolean {
  const step = document.steps[parent];
  if (step?.kind !== "try") return true;
  return branch !== "finally" || step.params.finally === true;
}

function branchWay({ branch }: BranchRef, exit: Box, target: Box): PixelPoint[] {
  return branch === "else" ? elbowSideways(exit, target) : elbow(exit, target);
}

/** The part of a step's outline that a branch leaves: Parallel's and Try's branches lie beside each other. */
function exitOf(input: LinkInput, { parent, branch }: BranchRef, from: Box): Box {
  const step = input.document.steps[parent];
  if (step?.kind !== "parallel" && step?.kind !== "try") return from;
  const branches = drawnExits(input, { parent, branch }, step);
  const width = (from.right - from.left) / Math.max(1, branches.length);
  const left = from.left + width * Math.max(0, branches.indexOf(branch));
  return branch === "body" ? from : { ...from, left, right: left + width };
}

function drawnExits(input: LinkInput, { parent }: BranchRef, step: Step): readonly string[] {
  return branchesOf(step).filter((each) => each !== "body" && isDrawn(input, { parent, branch: each }));
}

function isDrawn({ document, tree }: LinkInput, into: BranchRef): boolean {
  return tree.children(into.parent, into.branch).length > 0 || offersBranch(document, into);
}

/** What the arrow into a branch says; an event's arrow needs no word. */
export function branchWord(branch: string, step: Step, t: Translate): string {
  if (step.kind === "on_event") return "";
  if (step.kind === "parallel") return branch;
  if (step.kind !== "try" || !isCatch(branch)) return t(`branch.${branch}`);
  const taken = takenBy(branch, step, t);
  return taken === null ? t("branch.catch") : t("branch.catch_of", { taken });
}

/** An empty branch: a short way out at its usual side. */
function stub(box: Box, branch: string, row = 0): PixelPoint[] {
  const across = (box.left + box.right) / 2;
  const down = (box.top + box.bottom) / 2;
  if (branch === "else")
    return [
      { x: across, y: box.top },
      { x: across, y: box.top - 44 },
    ];
  if (["then", "finally", "body"].includes(branch) || isCatch(branch))
    return [
      { x: across, y: box.bottom },
      { x: across, y: box.bottom + 42 + row * ROW },
    ];
  const side = branch === "a" ? -1 : 1;
  const edge = side < 0 ? box.left : box.right;
  return [
    { x: edge, y: down },
    { x: edge + side * 48, y: down },
  ];
}

function boxOf(input: LinkInput, id: string): Box | null {
  return input.frames.get(id)?.box ?? input.chips.get(id)?.box ?? null;
}

export interface WordPlace {
  readonly x: number;
  readonly y: number;
  /** Over a flat stretch the word stands in the middle, beside a steep one it begins there. */
  readonly anchor: "middle" | "start";
}

const ALONG = 24;
const LETTER = 6.6;
/** Words of neighbouring ways out stand in rows of this height, so many below each other. */
const ROW = 15;
const ROWS = 3;

export function wordPlace(link: Pick<Link, "points" | "row">): WordPlace | null {
  const lower = (link.row ?? 0) * ROW;
  const at = pointAlong(link.points, Math.min(ALONG + lower, pathLength(link.points) / (lower > 0 ? 1.3 : 2)));
  if (!at) return null;
  const flat = Math.abs(at.angle) < 45 || Math.abs(at.angle) > 135;
  return flat ? { x: at.x, y: at.y - 7, anchor: "middle" } : { x: at.x + 8, y: at.y + 4, anchor: "start" };
}

/** About the room that the word takes. */
export function wordBox(link: Pick<Link, "points" | "word" | "row">): Box | null {
  const place = link.word ? wordPlace(link) : null;
  if (!place || !link.word) return null;
  const width = link.word.length * LETTER;
  const left = place.anchor === "middle" ? place.x - width / 2 : place.x;
  return { left, right: left + width, top: place.y - 11, bottom: place.y + 4 };
}
