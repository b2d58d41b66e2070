/** Specks: walls of few cells, as a laser sees dust, legs and people. Pure. */
import type { CellMap } from "@/map/floor/rosFiles";

const [FREE, WALL, UNKNOWN] = [0, 100, 255];

/** Take away the walls that have fewer than `least` joined cells (corners join, too), and tell how many there were. */
export function eraseSpecks(map: CellMap, least: number): { map: CellMap; specks: number } {
  const { width, height } = map;
  const cells = map.cells.slice();
  const seen = new Uint8Array(cells.length);
  let specks = 0;
  for (let start = 0; start < cells.length; start += 1) {
    if (cells[start] !== WALL || seen[start]) continue;
    const { speck, floor } = joined(map.cells, seen, start, width, height);
    if (speck.length >= least) continue;
    specks += 1;
    for (const at of speck) cells[at] = floor ? FREE : UNKNOWN;
  }
  return specks ? { map: { ...map, cells }, specks } : { map, specks: 0 };
}

/** The walls that are joined with one cell, and whether floor lies beside them. */
function joined(cells: Uint8Array, seen: Uint8Array, start: number, width: number, height: number) {
  const speck = [start];
  let floor = false;
  seen[start] = 1;
  for (const at of speck) {
    // grows while it is gone through
    const [column, row] = [at % width, Math.floor(at / width)];
    for (let r = Math.max(0, row - 1); r <= Math.min(height - 1, row + 1); r += 1)
      for (let c = Math.max(0, column - 1); c <= Math.min(width - 1, column + 1); c += 1) {
        const next = r * width + c;
        if (cells[next] === FREE) floor = true;
        if (cells[next] !== WALL || seen[next]) continue;
        seen[next] = 1;
        speck.push(next);
      }
  }
  return { speck, floor };
}
