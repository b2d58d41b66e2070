/** A function's body on the map: the hull around the places that it touches. */
import { type PixelPoint, simplified } from "@/map/plane/paths";
import type { Box } from "@/map/plane/projection";
import type { ProgramDocument } from "../document/document";
import { type ProgramTree, withDescendants } from "../document/tree";
import type { Surroundings } from "../surroundings";
import type { Chip } from "./chips";
import { grown, legBoxes } from "./geometry";
import { endOf, type RouteShape, startOf } from "./stepPaths";

export interface Hull {
  readonly functionId: string;
  /** Closed edges. */
  readonly outlines: readonly (readonly PixelPoint[])[];
}

export function hullsOf(
  document: ProgramDocument,
  tree: ProgramTree,
  chips: ReadonlyMap<string, Chip>,
  routes: ReadonlyMap<string, RouteShape>,
  surroundings: Surroundings,
  collapsed: ReadonlySet<string>,
): Hull[] {
  return Object.keys(document.functions)
    .filter((id) => !collapsed.has(id))
    .map((id) => {
      const inside = [...withDescendants(document, tree.children(id, "body"))];
      const boxes = inside.flatMap((step) => boxesOf(step, document, id, chips, routes, surroundings));
      return { functionId: id, outlines: outlinesAround(boxes) };
    })
    .filter((hull) => hull.outlines.length > 0);
}

function boxesOf(
  id: string,
  document: ProgramDocument,
  scope: string,
  chips: ReadonlyMap<string, Chip>,
  routes: ReadonlyMap<string, RouteShape>,
  surroundings: Surroundings,
): Box[] {
  const step = document.steps[id];
  if (!step) return [];
  const spots = [startOf(step, document, surroundings, scope), endOf(step, document, surroundings, scope)];
  const places = spots.flatMap((spot) => (spot?.box ? [{ ...grown(spot.box, 26), top: spot.box.top - 46 }] : []));
  const chip = chips.get(id);
  return [...places, ...(chip ? [grown(chip.box, 10)] : []), ...legBoxes(routes.get(id)?.points ?? [], 24)];
}

const CELL = 23;

type Cells = Set<string>;

/** The closed edges around all boxes; rows and columns have no gaps. */
export function outlinesAround(boxes: readonly Box[]): PixelPoint[][] {
  const cells: Cells = new Set(boxes.flatMap(cellsOf));
  while (fillGaps(cells, 0) + fillGaps(cells, 1) > 0) continue;
  return traced(cells).map((edge) => edge.map(({ x, y }) => ({ x: x * CELL, y: y * CELL })));
}

function cellsOf(box: Box): string[] {
  const found: string[] = [];
  for (let x = Math.round(box.left / CELL); x < Math.round(box.right / CELL); x += 1)
    for (let y = Math.round(box.top / CELL); y < Math.round(box.bottom / CELL); y += 1) found.push(`${x},${y}`);
  return found;
}

/** Fills each row (axis 0) or column (axis 1) from its first to its last cell; how many were missing. */
function fillGaps(cells: Cells, axis: 0 | 1): number {
  const spans = new Map<number, [number, number]>();
  for (const cell of cells) {
    const at = cell.split(",").map(Number);
    const [along, across] = [at[axis] ?? 0, at[1 - axis] ?? 0];
    const span = spans.get(across) ?? [along, along];
    spans.set(across, [Math.min(span[0], along), Math.max(span[1], along)]);
  }
  const before = cells.size;
  for (const [across, [from, to]] of spans)
    for (let along = from; along <= to; along += 1) cells.add(axis === 0 ? `${along},${across}` : `${across},${along}`);
  return cells.size - before;
}

/** Walks along the edges with the filled side on the right. */
function traced(cells: Cells): PixelPoint[][] {
  const next = edgesOf(cells);
  const found: PixelPoint[][] = [];
  for (const start of [...next.keys()]) {
    const edge: PixelPoint[] = [];
    for (let at: string | undefined = start; at !== undefined && next.has(at);) {
      const [x = 0, y = 0] = at.split(",").map(Number);
      edge.push({ x, y });
      const to: string | undefined = next.get(at)?.pop();
      if (!next.get(at)?.length) next.delete(at);
      at = to;
    }
    if (edge.length > 2) found.push(withoutSeam(edge));
  }
  return found;
}

function edgesOf(cells: Cells): Map<string, string[]> {
  const next = new Map<string, string[]>();
  const add = (from: string, to: string) => next.set(from, [...(next.get(from) ?? []), to]);
  for (const cell of cells) {
    const [x = 0, y = 0] = cell.split(",").map(Number);
    if (!cells.has(`${x},${y - 1}`)) add(`${x},${y}`, `${x + 1},${y}`);
    if (!cells.has(`${x + 1},${y}`)) add(`${x + 1},${y}`, `${x + 1},${y + 1}`);
    if (!cells.has(`${x},${y + 1}`)) add(`${x + 1},${y + 1}`, `${x},${y + 1}`);
    if (!cells.has(`${x - 1},${y}`)) add(`${x},${y + 1}`, `${x},${y}`);
  }
  return next;
}

/** Corners only; the walk may have begun and ended in the middle of a side. */
function withoutSeam(edge: readonly PixelPoint[]): PixelPoint[] {
  const [first, last] = [edge[0], edge.at(-1)];
  if (!first || !last) return [];
  return simplified([last, ...edge, first]).slice(1, -1);
}
