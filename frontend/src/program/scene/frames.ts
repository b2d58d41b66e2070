/** Frames: a While or Try around those of its steps that stand beside its head. */
import type { Box } from "@/map/plane/projection";
import type { ProgramDocument } from "../document/document";
import type { ProgramTree } from "../document/tree";
import type { Chip } from "./chips";
import { boxAt, gap, grown, overlaps, union } from "./geometry";

export interface Frame {
  readonly id: string;
  readonly kind: string;
  readonly box: Box;
  /** Children inside; the others are reached by a dotted arrow. */
  readonly holds: ReadonlySet<string>;
  readonly empty: boolean;
}

/** Drawing pixels: a step farther than this from its frame's head is drawn where it is. */
const REACH = 130;
const PADDING = 10;

export function framesOf(
  document: ProgramDocument,
  tree: ProgramTree,
  chips: ReadonlyMap<string, Chip>,
): Map<string, Frame> {
  const frames = new Map<string, Frame>();
  // Innermost first, so that an outer frame goes around the whole of an inner one.
  for (const id of [...tree.reading].reverse()) {
    const [step, chip] = [document.steps[id], chips.get(id)];
    if (!step || !chip || chip.shape !== "header") continue;
    frames.set(id, frameAround(id, step.kind, chip, tree.children(id, "body"), chips, frames));
  }
  return frames;
}

/** Between a head and the step that it made room for. */
const APART = 8;

/** Heads that would lie on the steps beside them, as where a language has longer words, make room to the left. */
export function clearHeads(document: ProgramDocument, tree: ProgramTree, chips: Map<string, Chip>): void {
  for (const id of tree.reading) {
    const head = chips.get(id);
    if (!document.steps[id] || head?.shape !== "header") continue;
    const covered = tree.children(id, "body").flatMap((child) => {
      const box = chips.get(child)?.box;
      return box && overlaps(head.box, box) && box.left > head.box.left ? [box.left] : [];
    });
    if (covered.length === 0) continue;
    const at = { x: head.at.x - (head.box.right + APART - Math.min(...covered)), y: head.at.y };
    chips.set(id, { ...head, at, box: boxAt(at, head.width, head.height) });
  }
}

function frameAround(
  id: string,
  kind: string,
  head: Chip,
  children: readonly string[],
  chips: ReadonlyMap<string, Chip>,
  frames: ReadonlyMap<string, Frame>,
): Frame {
  let box = head.box;
  const holds = new Set<string>();
  for (const child of children) {
    const inner = frames.get(child)?.box ?? chips.get(child)?.box;
    if (!inner || gap(box, inner) > REACH) continue;
    box = union(box, inner);
    holds.add(child);
  }
  const room = holds.size === 0 ? { ...box, bottom: box.bottom + 26 } : box;
  return { id, kind, box: grown(room, PADDING), holds, empty: children.length === 0 };
}

/** The innermost frame around a point of the drawing plane. */
export function frameAt(frames: readonly Frame[], point: { x: number; y: number }): Frame | null {
  const around = frames.filter(
    ({ box }) => point.x > box.left && point.x < box.right && point.y > box.top && point.y < box.bottom,
  );
  const area = ({ box }: Frame) => (box.right - box.left) * (box.bottom - box.top);
  return around.sort((one, other) => area(one) - area(other))[0] ?? null;
}
