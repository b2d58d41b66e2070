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
  readonly #cells = new Map<string, number[]>();
  readonly #large: number[] = [];

  constructor(readonly items: readonly T[]) {
    items.forEach(({ box }, at) => {
      const [left, right, top, bottom] = cellsOf(box);
      if ((right - left + 1) * (bottom - top + 1) > MOST_CELLS) this.#large.push(at);
      else
        for (let x = left; x <= right; x += 1) for (let y = top; y <= bottom; y += 1) this.#cell(`${x},${y}`).push(at);
    });
  }

  /** What touches the box, in the order in which it was given. */
  within(box: Box): T[] {
    const [left, right, top, bottom] = cellsOf(box);
    if ((right - left + 1) * (bottom - top + 1) >= this.#cells.size + MOST_CELLS)
      return this.items.filter((item) => overlaps(item.box, box));
    const found = new Set(this.#large);
    for (let x = left; x <= right; x += 1)
      for (let y = top; y <= bottom; y += 1) for (const at of this.#cells.get(`${x},${y}`) ?? []) found.add(at);
    const inOrder = [...found].sort((one, other) => one - other);
    return inOrder.flatMap((at) => {
      const item = this.items[at];
      return item && overlaps(item.box, box) ? [item] : [];
    });
  }

  #cell(name: string): number[] {
    const cell = this.#cells.get(name) ?? [];
    this.#cells.set(name, cell);
    return cell;
  }
}

function cellsOf(box: Box): [left: number, right: number, top: number, bottom: number] {
  return [
    Math.floor(box.left / CELL),
    Math.floor(box.right / CELL),
    Math.floor(box.top / CELL),
    Math.floor(box.bottom / CELL),
  ];
}
