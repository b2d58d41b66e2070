/** What the cells of a map tell. Pure. */
interface Cells {
  readonly cells: Uint8Array;
  readonly resolution_m: number;
}

function share(cells: Uint8Array, accept: (cell: number) => boolean): number {
  let found = 0;
  for (const cell of cells) if (accept(cell)) found += 1;
  return found;
}

/** Square metres that are free. */
export function freeArea({ cells, resolution_m }: Cells): number {
  return share(cells, (cell) => cell === 0) * resolution_m * resolution_m;
}

/** 0 to 1: how much of the map is known. */
export function knownShare({ cells }: Cells): number {
  return cells.length > 0 ? share(cells, (cell) => cell !== 255) / cells.length : 0;
}
