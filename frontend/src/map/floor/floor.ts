/** The floor as shapes that a canvas can fill crisply at any zoom: boxes instead of pixels. */
import { PIXELS_PER_METRE, type Box, type Point } from "../plane/projection";

export interface MapPlace {
  readonly id: string;
  readonly name: string;
  readonly kind: string;
  readonly x: number;
  readonly y: number;
  readonly theta: number;
  /** Where its name is written, metres; at the place itself where it is not said. */
  readonly label?: readonly [number, number] | null;
}

/** An area of the floor with a rule for all robots; metres, metres a second. */
export interface MapZone {
  readonly id: string;
  readonly name: string;
  readonly rule: "keep_out" | "slow" | "one_at_a_time" | "one_way" | "preferred" | "release";
  readonly points: readonly Point[];
  readonly speed_m_s: number | null;
  /** How many may be in it at once, where its rule is that. */
  readonly robots: number | null;
  /** Where one drives in it, where its rule is that: degrees from the x axis, counter-clockwise. */
  readonly heading_deg: number | null;
  /** Until when all robots drive in freely that are let in one by one else. */
  readonly open_until?: string | null;
}

/** A round thing on the floor that is on no map; metres. */
export interface MapObstacle {
  readonly x: number;
  readonly y: number;
  readonly size_m: number;
}

/** One version of a site's map; `cells` row by row from the bottom row: 0 free, 100 wall, 255 unknown. */
export interface FloorPlan {
  readonly version: number;
  /** Another one for another map of the same number, as after a backup came back; not of a recorded floor. */
  readonly tag?: string;
  readonly width: number;
  readonly height: number;
  readonly resolution_m: number;
  readonly origin: { readonly x: number; readonly y: number };
  readonly places: readonly MapPlace[];
  readonly zones?: readonly MapZone[];
  /** What simulated robots meet. */
  readonly obstacles?: readonly MapObstacle[];
  readonly cells: Uint8Array;
}

/** Columns and rows, ends not included; rows count from the bottom. */
export interface CellBox {
  column: number;
  row: number;
  columns: number;
  rows: number;
}

/** Cover all cells that `accept` names with boxes: runs of a row, joined with equal runs of the rows above. */
export function mergeCells(plan: FloorPlan, accept: (cell: number) => boolean): CellBox[] {
  const done: CellBox[] = [];
  let open = new Map<number, CellBox>();
  for (let row = 0; row < plan.height; row += 1) {
    const next = new Map<number, CellBox>();
    for (const [column, columns] of runs(plan, row, accept)) {
      const below = open.get(column);
      if (below && below.columns === columns) below.rows += 1;
      const box = below && below.columns === columns ? below : { column, row, columns, rows: 1 };
      if (box !== below) done.push(box);
      next.set(column, box);
    }
    open = next;
  }
  return done;
}

function runs(plan: FloorPlan, row: number, accept: (cell: number) => boolean): [number, number][] {
  const found: [number, number][] = [];
  const start = row * plan.width;
  let from = -1;
  for (let column = 0; column <= plan.width; column += 1) {
    const inside = column < plan.width && accept(plan.cells[start + column] ?? 255);
    if (inside && from < 0) from = column;
    if (!inside && from >= 0) {
      found.push([from, column - from]);
      from = -1;
    }
  }
  return found;
}

/** Where a box of cells stands on the drawing plane. */
export function cellBoxToPixels(plan: FloorPlan, box: CellBox): Box {
  const side = plan.resolution_m * PIXELS_PER_METRE;
  const left = plan.origin.x * PIXELS_PER_METRE + box.column * side;
  const bottom = -plan.origin.y * PIXELS_PER_METRE - box.row * side;
  return { left, bottom, right: left + box.columns * side, top: bottom - box.rows * side };
}

const walls = new WeakMap<Uint8Array, Box[]>();

/** The walls on the drawing plane; kept for as long as the cells are. */
export function wallBoxes(plan: FloorPlan): readonly Box[] {
  const known = walls.get(plan.cells);
  if (known) return known;
  const boxes = mergeCells(plan, (cell) => cell === 100).map((box) => cellBoxToPixels(plan, box));
  walls.set(plan.cells, boxes);
  return boxes;
}

/** The whole map on the drawing plane. */
export function planBox(plan: FloorPlan): Box {
  return cellBoxToPixels(plan, { column: 0, row: 0, columns: plan.width, rows: plan.height });
}

/** The least zoom of a map that is moved: a fifth, or where all of a large one is seen on a small pane. */
export function leastZoom(plan: FloorPlan | null): number {
  if (!plan) return 0.2;
  const { left, right, top, bottom } = planBox(plan);
  return Math.min(0.2, 200 / (right - left), 150 / (bottom - top));
}

const floors = new WeakMap<FloorPlan, Box>();

/** The part of the map that is known (not 255), so that a wide empty margin does not make the floor small. */
export function knownBox(plan: FloorPlan): Box {
  const box = floors.get(plan) ?? boxOfKnown(plan);
  floors.set(plan, box);
  return box;
}

function boxOfKnown(plan: FloorPlan): Box {
  let [left, right, bottom, top] = [plan.width, 0, plan.height, 0];
  for (let row = 0; row < plan.height; row += 1)
    for (const [column, columns] of runs(plan, row, (cell) => cell !== 255)) {
      left = Math.min(left, column);
      right = Math.max(right, column + columns);
      bottom = Math.min(bottom, row);
      top = Math.max(top, row + 1);
    }
  if (right <= left) return planBox(plan);
  return cellBoxToPixels(plan, { column: left, row: bottom, columns: right - left, rows: top - bottom });
}

/** The cell at a point in metres; 255 off the map. */
export function cellAt(plan: FloorPlan, point: Point): number {
  const column = Math.floor((point[0] - plan.origin.x) / plan.resolution_m);
  const row = Math.floor((point[1] - plan.origin.y) / plan.resolution_m);
  if (column < 0 || row < 0 || column >= plan.width || row >= plan.height) return 255;
  return plan.cells[row * plan.width + column] ?? 255;
}

/** The rules of zones that lead robots elsewhere. */
const LEADING: readonly MapZone["rule"][] = ["keep_out", "one_way", "preferred", "release"];
const marks = new WeakMap<FloorPlan, string>();

/** Differs whenever robots would drive over another floor: another map, or other zones that lead them elsewhere. */
export function floorMark(plan: FloorPlan | null | undefined): string | undefined {
  if (!plan) return undefined;
  const known = marks.get(plan);
  if (known !== undefined) return known;
  const leading = (plan.zones ?? [])
    .filter(({ rule }) => LEADING.includes(rule))
    .map(({ rule, points, heading_deg }) => [rule, points, heading_deg]);
  const mark = (plan.tag ?? String(plan.version)) + (leading.length > 0 ? `-${hashOf(JSON.stringify(leading))}` : "");
  marks.set(plan, mark);
  return mark;
}

/** FNV-1a of 32 bits. */
function hashOf(text: string): string {
  let hash = 0x811c9dc5;
  for (let at = 0; at < text.length; at += 1) hash = Math.imul(hash ^ text.charCodeAt(at), 0x01000193) >>> 0;
  return hash.toString(36);
}
