/** A brought map in the frame of the present one, cell on cell. Pure. */
import type { CellMap } from "@/map/floor/rosFiles";
import { UNKNOWN, WALL } from "../plan/picture";
import { inverse, transform, type Point, type Similarity } from "./similarity";

const MOST_SIDE = 4096;

type Frame = Pick<CellMap, "resolution_m" | "origin">;

function corners({ width, height, resolution_m: side, origin }: CellMap): Point[] {
  const [right, top] = [origin.x + width * side, origin.y + height * side];
  return [
    [origin.x, origin.y],
    [right, origin.y],
    [right, top],
    [origin.x, top],
  ];
}

function round(metres: number): number {
  return Math.round(metres * 1e9) / 1e9;
}

/** Null where it had too many cells. A cell is what lies under its middle, and wall where a wall's middle comes to lie. */
export function alignedMap(brought: CellMap, by: Similarity, frame: Frame): CellMap | null {
  const side = frame.resolution_m;
  const moved = corners(brought).map((corner) => transform(by, corner));
  const [xs, ys] = [moved.map(([x]) => (x - frame.origin.x) / side), moved.map(([, y]) => (y - frame.origin.y) / side)];
  const [left, bottom] = [Math.floor(Math.min(...xs) + 1e-6), Math.floor(Math.min(...ys) + 1e-6)];
  const width = Math.ceil(Math.max(...xs) - 1e-6) - left;
  const height = Math.ceil(Math.max(...ys) - 1e-6) - bottom;
  if (!(width >= 1 && height >= 1 && width <= MOST_SIDE && height <= MOST_SIDE)) return null;
  const origin = { x: round(frame.origin.x + left * side), y: round(frame.origin.y + bottom * side) };
  const cells = new Uint8Array(width * height).fill(UNKNOWN);
  const map = { width, height, resolution_m: side, origin, cells };
  fill(map, brought, inverse(by));
  keepWalls(map, brought, by);
  return map;
}

function fill(map: CellMap, brought: CellMap, back: Similarity): void {
  const { width, height, resolution_m: side, origin } = map;
  for (let row = 0; row < height; row += 1)
    for (let column = 0; column < width; column += 1) {
      const at = cellAt(brought, transform(back, [origin.x + (column + 0.5) * side, origin.y + (row + 0.5) * side]));
      if (at >= 0) map.cells[row * width + column] = brought.cells[at] ?? UNKNOWN;
    }
}

/** Thin walls stay whole where cells become larger. */
function keepWalls(map: CellMap, brought: CellMap, by: Similarity): void {
  const { width, resolution_m: side, origin } = brought;
  brought.cells.forEach((cell, index) => {
    if (cell !== WALL) return;
    const [row, column] = [Math.floor(index / width), index % width];
    const at = cellAt(map, transform(by, [origin.x + (column + 0.5) * side, origin.y + (row + 0.5) * side]));
    if (at >= 0) map.cells[at] = WALL;
  });
}

function cellAt({ width, height, resolution_m: side, origin }: CellMap, [x, y]: Point): number {
  const [column, row] = [Math.floor((x - origin.x) / side), Math.floor((y - origin.y) / side)];
  return column >= 0 && row >= 0 && column < width && row < height ? row * width + column : -1;
}
