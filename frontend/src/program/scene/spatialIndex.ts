/** Finds what lies in a part of the drawing plane without looking at all of it: a grid of cells. Pure. */
import type { Box } from "@/map/plane/projection";
import { overlaps } from "./geometry";

export interface Placed {
  readonly box: Box;
}

/** Drawing pixels. */
const CELL = 256;
/** Whatever lies in more cells than this is looked at each time. */
const MOST_CELLS = 64;

export class SpatialIndex<T extends Placed> {
  readonly #cells = new Map<number, number[]>();
  readonly #large: number[] = [];
  /** The last search that came upon each item: one that lies in several cells is found once. */
  readonly #foundBy: Uint32Array;
  #search = 0;

  constructor(readonly items: readonly T[]) {
    this.#foundBy = new Uint32Array(items.length);
    items.forEach(({ box }, at) => {
      const [left, right, top, bottom] = cellsOf(box);
      if ((right - left + 1) * (bottom - top + 1) > MOST_CELLS) this.#large.push(at);
      else for (let x = left; x <= right; x += 1) for (let y = top; y <= bottom; y += 1) this.#cell(x, y).push(at);
    });
  }

  /** What touches the box, in the order in which it was given. */
  within(box: Box): T[] {
    const [left, right, top, bottom] = cellsOf(box);
    if ((right - left + 1) * (bottom - top + 1) >= this.#cells.size + MOST_CELLS)
      return this.items.filter((item) => overlaps(item.box, box));
    this.#search += 1;
    const found: number[] = [];
    this.#collect(this.#large, box, found);
    for (let x = left; x <= right; x += 1)
      for (let y = top; y <= bottom; y += 1) this.#collect(this.#cells.get(keyOf(x, y)), box, found);
    return found.sort((one, other) => one - other).flatMap((at) => this.items[at] ?? []);
  }

  #collect(candidates: readonly number[] | undefined, box: Box, found: number[]): void {
    for (const at of candidates ?? []) {
      if (this.#foundBy[at] === this.#search) continue;
      this.#foundBy[at] = this.#search;
      const item = this.items[at];
      if (item && overlaps(item.box, box)) found.push(at);
    }
  }

  #cell(x: number, y: number): number[] {
    const key = keyOf(x, y);
    const cell = this.#cells.get(key) ?? [];
    this.#cells.set(key, cell);
    return cell;
  }
}

/** One number for a cell, different for any two of a drawing that fits into a million cells each way. */
function keyOf(x: number, y: number): number {
  return x * 2 ** 21 + y;
}

function cellsOf(box: Box): [left: number, right: number, top: number, bottom: number] {
  return [
    Math.floor(box.left / CELL),
    Math.floor(box.right / CELL),
    Math.floor(box.top / CELL),
    Math.floor(box.bottom / CELL),
  ];
}
