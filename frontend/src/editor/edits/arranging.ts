/** Steps aligned, spread evenly or put into tidy rows: how far each one moves, in drawing pixels. */
import { type Box, type Point, PIXELS_PER_METRE } from "@/map/plane/projection";
import { withDescendants } from "@/program/document/tree";
import type { ProgramDocument } from "@/program/document/document";
import type { Frame } from "@/program/scene/frames";
import type { Edit } from "./edits";

export interface Standing {
  readonly id: string;
  readonly box: Box;
}

export type Side = "left" | "centre" | "right" | "top" | "middle" | "bottom";
export type Axis = "across" | "down";
/** By how many drawing pixels each step moves. */
export type Shifts = ReadonlyMap<string, { readonly x: number; readonly y: number }>;

/** Between tidy steps, drawing pixels. */
const GAP = 26;
/** More steps than these stand in several rows. */
const ONE_ROW = 6;

const SIDES: Readonly<Record<Side, (box: Box, around: Box) => { x: number; y: number }>> = {
  left: (box, around) => ({ x: around.left - box.left, y: 0 }),
  centre: (box, around) => ({ x: midX(around) - midX(box), y: 0 }),
  right: (box, around) => ({ x: around.right - box.right, y: 0 }),
  top: (box, around) => ({ x: 0, y: around.top - box.top }),
  middle: (box, around) => ({ x: 0, y: midY(around) - midY(box) }),
  bottom: (box, around) => ({ x: 0, y: around.bottom - box.bottom }),
};

export function aligned(steps: readonly Standing[], side: Side): Shifts {
  const around = boxOf(steps);
  return new Map(steps.map(({ id, box }) => [id, SIDES[side](box, around)]));
}

/** The same gap between all neighbours; the outermost stay. */
export function spread(steps: readonly Standing[], axis: Axis): Shifts {
  const [near, far] = axis === "across" ? (["left", "right"] as const) : (["top", "bottom"] as const);
  const inOrder = [...steps].sort((one, other) => one.box[near] + one.box[far] - other.box[near] - other.box[far]);
  const around = boxOf(steps);
  const used = steps.reduce((sum, { box }) => sum + box[far] - box[near], 0);
  const gap = (around[far] - around[near] - used) / Math.max(1, steps.length - 1);
  let next = around[near];
  return new Map(
    inOrder.map(({ id, box }) => {
      const by = next - box[near];
      next += box[far] - box[near] + gap;
      return [id, axis === "across" ? { x: by, y: 0 } : { x: 0, y: by }];
    }),
  );
}

/** In the order in which they are given, in a row or a column as they stand more or less now; many in several rows. */
export function tidied(steps: readonly Standing[]): Shifts {
  const around = boxOf(steps);
  const wide = around.right - around.left > around.bottom - around.top;
  const columns = steps.length > ONE_ROW ? Math.ceil(Math.sqrt(steps.length)) : wide ? steps.length : 1;
  const cell = {
    width: Math.max(...steps.map(({ box }) => box.right - box.left)) + GAP,
    height: Math.max(...steps.map(({ box }) => box.bottom - box.top)) + GAP,
  };
  const first = { x: around.left + (cell.width - GAP) / 2, y: around.top + (cell.height - GAP) / 2 };
  return new Map(
    steps.map(({ id, box }, index) => {
      const x = first.x + (index % columns) * cell.width;
      const y = first.y + Math.floor(index / columns) * cell.height;
      return [id, { x: x - midX(box), y: y - midY(box) }];
    }),
  );
}

/** Where the steps would stand. */
export function shifted(steps: readonly Standing[], shifts: Shifts): readonly Standing[] {
  return steps.map(({ id, box }) => {
    const { x, y } = shifts.get(id) ?? { x: 0, y: 0 };
    return { id, box: { left: box.left + x, right: box.right + x, top: box.top + y, bottom: box.bottom + y } };
  });
}

/** The steps moved, with all that stands in them. */
export function moveBy(document: ProgramDocument, shifts: Shifts): readonly Edit[] {
  return [...shifts].flatMap(([id, { x, y }]) => {
    if (Math.abs(x) < 0.5 && Math.abs(y) < 0.5) return [];
    return movedBy(document, withDescendants(document, [id]), [x / PIXELS_PER_METRE, -y / PIXELS_PER_METRE]);
  });
}

/** What is drawn: the document, and the frames on the map. */
interface Drawn {
  readonly document: ProgramDocument;
  readonly scene: { readonly frames: readonly Frame[] };
}

/** What a step takes along when it is put elsewhere: all that stands in its frame, with what is in that. */
export function takenAlong({ document, scene }: Drawn, id: string): ReadonlySet<string> {
  const frame = scene.frames.find((each) => each.id === id);
  return withDescendants(document, frame?.holds ?? []);
}

/** The steps, each with what it takes along, moved by so many metres. */
export function moveTogether(drawn: Drawn, ids: readonly string[], by: Point): readonly Edit[] {
  const all = ids.flatMap((id) => [id, ...takenAlong(drawn, id)]);
  return movedBy(drawn.document, new Set(all), by);
}

/** Those of the steps that stand somewhere, moved by so many metres. */
export function movedBy(document: ProgramDocument, ids: ReadonlySet<string>, [dx, dy]: Point): readonly Edit[] {
  const round = (value: number) => Math.round(value * 100) / 100 + 0;
  return [...ids].flatMap((id): Edit[] => {
    const pos = document.steps[id]?.pos;
    return pos ? [{ do: "set_pos", id, pos: [round(pos[0] + dx), round(pos[1] + dy)] }] : [];
  });
}

export function boxOf(steps: readonly Standing[]): Box {
  return {
    left: Math.min(...steps.map(({ box }) => box.left)),
    right: Math.max(...steps.map(({ box }) => box.right)),
    top: Math.min(...steps.map(({ box }) => box.top)),
    bottom: Math.max(...steps.map(({ box }) => box.bottom)),
  };
}

function midX({ left, right }: Box): number {
  return (left + right) / 2;
}

function midY({ top, bottom }: Box): number {
  return (top + bottom) / 2;
}
