/** How much of a floor is free and how much is known. */
import { useMemo } from "react";

export interface FloorCounts {
  /** Cells that are free. */
  readonly free: number;
  /** 0 to 1: the part of all cells that is known. */
  readonly known: number;
}

/** Pure; looks at each cell once. */
export function countFloor(cells: Uint8Array): FloorCounts {
  let [free, known] = [0, 0];
  for (const cell of cells) {
    if (cell === 0) free += 1;
    if (cell !== 255) known += 1;
  }
  return { free, known: cells.length > 0 ? known / cells.length : 0 };
}

/** Counted anew for other cells only: there may be millions, and what shows them is drawn with each move of the map. */
export function useFloorCounts(cells: Uint8Array): FloorCounts {
  return useMemo(() => countFloor(cells), [cells]);
}
