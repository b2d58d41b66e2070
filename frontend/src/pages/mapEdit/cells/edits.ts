/** What people do to a map's cells by hand. Pure: each gives another map, or the same one where nothing changes. */
import type { CellMap } from "@/map/floor/rosFiles";
import type { Point } from "@/map/plane/projection";

export type Material = "wall" | "floor" | "unknown";
export const CELL: Readonly<Record<Material, number>> = { floor: 0, wall: 100, unknown: 255 };
export const LEAST_SIDE = 4;

/** Column and row of a point, also off the map. */
export function cellOf(map: CellMap, [x, y]: Point): readonly [column: number, row: number] {
  return [Math.floor((x - map.origin.x) / map.resolution_m), Math.floor((y - map.origin.y) / map.resolution_m)];
}

/** Fill what is at most half of `width` metres away from the way; a dot where that has one point. */
export function drawAlong(map: CellMap, way: readonly Point[], width: number, material: Material): CellMap {
  const cells = map.cells.slice();
  const half = Math.max(width, map.resolution_m) / 2;
  let changed = false;
  way.forEach((to, index) => {
    if (fillNear(map, cells, [way[index - 1] ?? to, to], half, CELL[material])) changed = true;
  });
  return changed ? { ...map, cells } : map;
}

function fillNear(map: CellMap, cells: Uint8Array, [a, b]: readonly [Point, Point], half: number, value: number) {
  const low = cellOf(map, [Math.min(a[0], b[0]) - half, Math.min(a[1], b[1]) - half]);
  const high = cellOf(map, [Math.max(a[0], b[0]) + half, Math.max(a[1], b[1]) + half]);
  let changed = false;
  for (let row = Math.max(0, low[1]); row <= Math.min(map.height - 1, high[1]); row += 1)
    for (let column = Math.max(0, low[0]); column <= Math.min(map.width - 1, high[0]); column += 1) {
      const at = row * map.width + column;
      if (cells[at] === value || distance(middleOf(map, column, row), a, b) > half) continue;
      cells[at] = value;
      changed = true;
    }
  return changed;
}

function middleOf({ origin, resolution_m }: CellMap, column: number, row: number): Point {
  return [origin.x + (column + 0.5) * resolution_m, origin.y + (row + 0.5) * resolution_m];
}

/** Metres from a point to the line from a to b; a hair less, so that a cell on the rim counts on both sides. */
function distance([x, y]: Point, a: Point, b: Point): number {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const square = dx * dx + dy * dy;
  const share = square ? Math.min(1, Math.max(0, ((x - a[0]) * dx + (y - a[1]) * dy) / square)) : 0;
  return Math.hypot(x - a[0] - share * dx, y - a[1] - share * dy) - 1e-9;
}

interface CellSpan {
  left: number;
  right: number;
  bottom: number;
  top: number;
}

/** The cells that the box between two points touches, ends not included; null where it is off the map. */
function spanOf(map: CellMap, a: Point, b: Point): CellSpan | null {
  const [one, other] = [cellOf(map, a), cellOf(map, b)];
  const left = Math.max(0, Math.min(one[0], other[0]));
  const right = Math.min(map.width, Math.max(one[0], other[0]) + 1);
  const bottom = Math.max(0, Math.min(one[1], other[1]));
  const top = Math.min(map.height, Math.max(one[1], other[1]) + 1);
  return right > left && top > bottom ? { left, right, bottom, top } : null;
}

/** Fill the box between two points. */
export function fillBox(map: CellMap, a: Point, b: Point, material: Material): CellMap {
  const span = spanOf(map, a, b);
  if (!span) return map;
  const cells = map.cells.slice();
  for (let row = span.bottom; row < span.top; row += 1)
    cells.fill(CELL[material], row * map.width + span.left, row * map.width + span.right);
  return { ...map, cells };
}

/** Keep only the box between two points; what stays keeps its coordinates. */
export function crop(map: CellMap, a: Point, b: Point): CellMap {
  const span = spanOf(map, a, b);
  if (!span) return map;
  const [width, height] = [span.right - span.left, span.top - span.bottom];
  if (width < LEAST_SIDE || height < LEAST_SIDE) return map;
  const cells = new Uint8Array(width * height);
  for (let row = 0; row < height; row += 1) {
    const from = (span.bottom + row) * map.width + span.left;
    cells.set(map.cells.subarray(from, from + width), row * width);
  }
  const { origin, resolution_m } = map;
  const corner = { x: exact(origin.x + span.left * resolution_m), y: exact(origin.y + span.bottom * resolution_m) };
  return { ...map, width, height, origin: corner, cells };
}

/** Make the whole map so many times as large; the zero of its coordinates stays. */
export function rescale(map: CellMap, factor: number): CellMap {
  const resolution_m = exact(map.resolution_m * factor);
  if (!(resolution_m >= 0.001 && resolution_m <= 10)) return map;
  return { ...map, resolution_m, origin: { x: exact(map.origin.x * factor), y: exact(map.origin.y * factor) } };
}

/** Without what floating point adds: a millionth of a metre is beyond every map. */
export function exact(metres: number): number {
  return Math.round(metres * 1e6) / 1e6 + 0;
}
