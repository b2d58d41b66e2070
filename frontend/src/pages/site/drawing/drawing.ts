/** A map out of the lines of a DXF drawing: the chosen layers as walls of a thickness. Pure. */
import type { CellMap } from "@/map/floor/rosFiles";
import { floodFromEdge, FREE, isTooLarge, WALL } from "../plan/picture";

export interface Layer {
  readonly name: string;
  /** Off or frozen in the drawing. */
  readonly hidden: boolean;
  /** Lines of x, y, x, y … in units of the drawing, y up. */
  readonly lines: readonly (readonly number[])[];
}

export interface Drawing {
  /** Metres of its unit; null: the drawing does not say. */
  readonly metres: number | null;
  readonly layers: readonly Layer[];
  /** How many parts of which kind are left out: blocks of another file (XREF) or of none (INSERT), and what is no line. */
  readonly skipped: Readonly<Record<string, number>>;
}

export interface DrawingReading {
  /** Metres of the drawing's unit; 0: not said yet. */
  readonly metres: number;
  readonly layers: readonly string[];
  readonly thickness: number;
  readonly cell: number;
  readonly outsideUnknown: boolean;
}

/** What a unit may be, in metres. */
export const UNITS = { mm: 0.001, cm: 0.01, dm: 0.1, m: 1, inch: 0.0254, foot: 0.3048, yard: 0.9144 } as const;
const MOST_SIDE = 4096;
/** Floor beside the outermost walls, in metres. */
const MARGIN = 0.5;
/** Coordinates of a country's survey: a map begins at zero instead. */
const FARTHEST = 100_000;

const BLOCKS = ["XREF", "INSERT"];
const FAR = "FAR";

/** How many blocks are left out, in which walls may be, how many lines that lie too far, and parts that are none. */
export function skippedOf({ skipped }: Drawing): { blocks: number; far: number; others: number } {
  const sum = (isMeant: (kind: string) => boolean) =>
    Object.entries(skipped).reduce((found, [kind, count]) => found + (isMeant(kind) ? count : 0), 0);
  const others = sum((kind) => kind !== FAR && !BLOCKS.includes(kind));
  return { blocks: sum((kind) => BLOCKS.includes(kind)), far: sum((kind) => kind === FAR), others };
}

/** A drawing as it is first looked at: what is hidden in it stays out. */
export function firstReading({ metres, layers }: Drawing): DrawingReading {
  const shown = layers.filter((layer) => !layer.hidden);
  return {
    metres: metres ?? 0,
    layers: (shown.length > 0 ? shown : layers).map((layer) => layer.name),
    thickness: 0.1,
    cell: 0.05,
    outsideUnknown: false,
  };
}

interface Extent {
  readonly left: number;
  readonly bottom: number;
  readonly right: number;
  readonly top: number;
}

function extentOf(lines: readonly (readonly number[])[], metres: number): Extent {
  let [left, bottom, right, top] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const line of lines)
    for (let at = 0; at + 1 < line.length; at += 2) {
      const [x, y] = [(line[at] ?? 0) * metres, (line[at + 1] ?? 0) * metres];
      [left, bottom, right, top] = [Math.min(left, x), Math.min(bottom, y), Math.max(right, x), Math.max(top, y)];
    }
  return { left, bottom, right, top };
}

function linesOf(drawing: Drawing, { layers }: DrawingReading) {
  return drawing.layers.filter((layer) => layers.includes(layer.name)).flatMap((layer) => layer.lines);
}

/** How large what is chosen is, in metres; null while the unit or the layers are not said. */
export function sizeOf(drawing: Drawing, reading: DrawingReading): { width: number; height: number } | null {
  const lines = linesOf(drawing, reading);
  if (!(reading.metres > 0) || lines.length === 0) return null;
  const { left, bottom, right, top } = extentOf(lines, reading.metres);
  return { width: right - left, height: top - bottom };
}

/** Whether a map of such cells would have too many. */
export function isTooFine(drawing: Drawing, reading: DrawingReading): boolean {
  const size = sizeOf(drawing, reading);
  return size !== null && (Math.max(size.width, size.height) + 2 * MARGIN) / reading.cell > MOST_SIDE - 2;
}

/** The map, in the drawing's own coordinates; null while the reading is not enough, or the cells were too many. */
export function mapFromDrawing(drawing: Drawing, reading: DrawingReading): CellMap | null {
  const { metres, cell, thickness, outsideUnknown } = reading;
  const size = sizeOf(drawing, reading);
  if (size === null || isTooLarge(size) || !(cell >= 0.001) || isTooFine(drawing, reading)) return null;
  const lines = linesOf(drawing, reading);
  const { left, bottom, right, top } = extentOf(lines, metres);
  const edge = MARGIN + thickness / 2;
  const start = { x: Math.floor((left - edge) / cell), y: Math.floor((bottom - edge) / cell) };
  const width = Math.ceil((right + edge) / cell) - start.x;
  const height = Math.ceil((top + edge) / cell) - start.y;
  const cells = new Uint8Array(width * height).fill(FREE);
  const stamp = discOf(thickness / 2 / cell);
  for (const line of lines) drawLine(cells, width, height, line, { scale: metres / cell, start, stamp });
  if (outsideUnknown) floodFromEdge(cells, width, height);
  const isNear = Math.max(Math.abs(start.x), Math.abs(start.y)) * cell < FARTHEST;
  const origin = isNear ? { x: round(start.x * cell), y: round(start.y * cell) } : { x: 0, y: 0 };
  return { width, height, resolution_m: cell, origin, cells };
}

function round(metres: number): number {
  return Math.round(metres * 1e6) / 1e6;
}

/** The cells around one whose middles are that near, in cells. */
function discOf(radius: number): readonly (readonly [number, number])[] {
  const reach = Math.floor(radius);
  const found: [number, number][] = [];
  for (let y = -reach; y <= reach; y += 1)
    for (let x = -reach; x <= reach; x += 1) if (Math.hypot(x, y) <= radius) found.push([x, y]);
  return found;
}

interface Pen {
  /** Cells of a unit of the drawing, and the cell that is the map's first. */
  readonly scale: number;
  readonly start: { readonly x: number; readonly y: number };
  readonly stamp: readonly (readonly [number, number])[];
}

/** March along a line by half a cell and leave wall. */
function drawLine(cells: Uint8Array, width: number, height: number, line: readonly number[], pen: Pen): void {
  const at = (index: number): [number, number] => [
    (line[index] ?? 0) * pen.scale - pen.start.x,
    (line[index + 1] ?? 0) * pen.scale - pen.start.y,
  ];
  for (let index = 0; index + 3 < line.length; index += 2) {
    const [[x1, y1], [x2, y2]] = [at(index), at(index + 2)];
    const steps = Math.max(1, Math.ceil(Math.hypot(x2 - x1, y2 - y1) * 2));
    for (let step = 0; step <= steps; step += 1) {
      const column = Math.floor(x1 + ((x2 - x1) * step) / steps);
      const row = Math.floor(y1 + ((y2 - y1) * step) / steps);
      for (const [dx, dy] of pen.stamp) {
        const [x, y] = [column + dx, row + dy];
        if (x >= 0 && y >= 0 && x < width && y < height) cells[y * width + x] = WALL;
      }
    }
  }
}
