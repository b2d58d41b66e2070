/** How two drawings become one picture: what is new as it stands, what was there as ghosts, old values before new. Pure. */
import type { ChangeKind, ConstructChange, Difference } from "@/api/types";
import type { PixelPoint } from "@/map/plane/paths";
import type { Chip, Measure } from "@/program/scene/chips";
import { boxAt } from "@/program/scene/geometry";
import type { Scene } from "@/program/scene/scene";
import type { TextPart } from "@/program/words/stepWords";

export type Shown = "old" | "both" | "new";

/** A change's tile on the corner of its chip, whichever drawing that stands in. */
export interface Tile {
  readonly key: string;
  readonly kind: ChangeKind;
  readonly at: PixelPoint;
}

/** A step where it no longer is. */
export interface Ghost {
  readonly kind: "removed" | "moved";
  readonly chip: Chip;
  /** Where it went. */
  readonly to: PixelPoint | null;
}

export const keyOf = ({ root, id }: Pick<ConstructChange, "root" | "id">) => `${root}/${id}`;

/** So far its old place must lie from where a moved step is drawn now to be shown, drawing pixels. */
const APART = 12;

/** What is drawn: on the old side alone what stood there, else what stands there now. */
export function drawnScene(shown: Shown, old: Scene, next: Scene, difference: Difference, measure: Measure): Scene {
  if (shown === "old") return old;
  return shown === "new" ? next : withOldValues(old, next, difference, measure);
}

/** Chips of changed steps say the old value, struck through, before the new one. */
function withOldValues(old: Scene, next: Scene, difference: Difference, measure: Measure): Scene {
  const chips = new Map(next.chips);
  for (const change of difference.constructs) {
    const [before, after] = [old.chips.get(change.id), next.chips.get(change.id)];
    if (change.root !== "steps" || change.kind !== "changed" || !before || !after) continue;
    chips.set(change.id, withParts(after, mergedParts(before.parts, after.parts), measure));
  }
  return { ...next, chips };
}

export function mergedParts(old: readonly TextPart[], next: readonly TextPart[]): readonly TextPart[] {
  if (old.length !== next.length) return next;
  return next.flatMap((part, at): TextPart[] => {
    const before = old[at];
    if (!before || before.text === part.text || before.tone === "missing") return [part];
    return [{ text: before.text, tone: "old" }, part];
  });
}

function withParts(chip: Chip, parts: readonly TextPart[], measure: Measure): Chip {
  if (parts === chip.parts || chip.shape === "diamond") return chip;
  const more = parts
    .filter((part) => part.tone === "old")
    .reduce((sum, part) => sum + measure(part.text, "chip") + 4, 0);
  const width = Math.ceil(chip.width + more);
  return { ...chip, parts, width, box: boxAt(chip.at, width, chip.height) };
}

/** What is no longer where it was: removed steps, and moved ones where they are drawn elsewhere. */
export function ghostsOf(shown: Shown, old: Scene, next: Scene, difference: Difference): Ghost[] {
  if (shown !== "both") return [];
  return difference.constructs.flatMap((change): Ghost[] => {
    const before = change.root === "steps" ? old.chips.get(change.id) : undefined;
    if (!before) return [];
    if (change.kind === "removed") return [{ kind: "removed", chip: before, to: null }];
    const after = next.chips.get(change.id);
    const far = after && Math.hypot(after.at.x - before.at.x, after.at.y - before.at.y) > APART;
    return change.kind === "moved" && after && far ? [{ kind: "moved", chip: before, to: after.at }] : [];
  });
}

export function tilesOf(drawn: Scene, ghosts: readonly Ghost[], difference: Difference): Tile[] {
  const standing = new Map([...ghosts.map(({ chip }) => [chip.id, chip] as const), ...drawn.chips]);
  return difference.constructs.flatMap((change): Tile[] => {
    const chip = change.root === "steps" ? standing.get(change.id) : undefined;
    if (!chip) return [];
    return [{ key: keyOf(change), kind: change.kind, at: { x: chip.box.left, y: chip.box.top } }];
  });
}

/** Where a change is to be seen; null for what has no place on the map. */
export function spotOf(change: ConstructChange, old: Scene, next: Scene): PixelPoint | null {
  if (change.root !== "steps") return null;
  return (next.chips.get(change.id) ?? old.chips.get(change.id))?.at ?? null;
}

/** The next change in a direction; from the last one on to the first. */
export function neighbour(keys: readonly string[], now: string | null, by: 1 | -1): string | null {
  if (keys.length === 0) return null;
  const at = now === null ? -1 : keys.indexOf(now);
  if (at < 0) return (by > 0 ? keys[0] : keys.at(-1)) ?? null;
  return keys[(at + by + keys.length) % keys.length] ?? null;
}
