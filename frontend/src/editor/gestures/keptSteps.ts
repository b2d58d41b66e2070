/** Steps that somebody removed and another person keeps: what went, and how it comes back. */
import { type ProgramDocument, textOf } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { ancestors, withDescendants } from "@/program/document/tree";
import type { Edit } from "../edits/edits";
import type { Ghost } from "../state/gestures";

type KeptSteps = Ghost["steps"];

/** The step and those in it that went together; `before` is the program in which they still stood. */
export function keptOf(before: ProgramDocument, id: string, gone: readonly string[]): KeptSteps {
  const within = withDescendants(before, [id]);
  return Object.fromEntries(Object.entries(before.steps).filter(([each]) => within.has(each) && gone.includes(each)));
}

/** What has come back since stays as it is. */
export function putBack(document: ProgramDocument, kept: KeptSteps): readonly Edit[] {
  return Object.entries(kept)
    .filter(([id]) => !Object.hasOwn(document.steps, id))
    .map(([id, step]): Edit => ({ do: "add_step", id, step }));
}

/**
 * Under which ids steps of functions go on whose last call was expanded: each that went with its function and a call of
 * it has the copy that the same change brought to its spot, and no other step has that one.
 */
export function copiesOf(before: ProgramDocument, gone: readonly string[], brought: KeptSteps): Map<string, string> {
  const expanded = new Set(
    gone.flatMap((id) => (before.steps[id]?.kind === "call" ? [textOf(before.steps[id].params.function)] : [])),
  );
  const copies = new Map<string, string>();
  const left = new Map(Object.entries(brought));
  for (const id of gone) {
    const top = ancestors(before, id).at(-1) ?? "";
    if (!expanded.has(top) || !Object.hasOwn(before.functions, top)) continue;
    for (const [copy, { kind, pos }] of left)
      if (kind === before.steps[id]?.kind && isSameValue(pos, before.steps[id].pos)) {
        copies.set(id, copy);
        left.delete(copy);
        break;
      }
  }
  return copies;
}
