/** One person's changes of a map until they are saved: what was before, what was undone. Pure. */
import type { CellMap } from "@/map/floor/rosFiles";

/** Cells of all maps together that are kept: older steps are forgotten beyond, a hundred for a map of 1.5 million. */
const MOST_CELLS = 150_000_000;

export interface Edits {
  readonly now: CellMap;
  readonly past: readonly CellMap[];
  readonly future: readonly CellMap[];
}

export const begin = (now: CellMap): Edits => ({ now, past: [], future: [] });

/** Go on with another map; nothing happens where it is the same. */
export function change(edits: Edits, next: CellMap): Edits {
  if (next === edits.now) return edits;
  return { now: next, past: bounded([...edits.past, edits.now]), future: [] };
}

export function undo({ now, past, future }: Edits): Edits {
  const before = past.at(-1);
  return before ? { now: before, past: past.slice(0, -1), future: [now, ...future] } : { now, past, future };
}

export function redo({ now, past, future }: Edits): Edits {
  const [next, ...rest] = future;
  return next ? { now: next, past: [...past, now], future: rest } : { now, past, future };
}

function bounded(past: readonly CellMap[]): readonly CellMap[] {
  let [kept, cells] = [past.length, 0];
  while (kept > 0 && (cells += past[kept - 1]?.cells.length ?? 0) <= MOST_CELLS) kept -= 1;
  return past.slice(Math.min(kept, past.length - 1));
}
