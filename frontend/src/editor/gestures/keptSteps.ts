/** Steps that somebody removed and another person keeps: what went, and how it comes back. */
import type { ProgramDocument, Step } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { withDescendants } from "@/program/document/tree";
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

/** Of the steps that the same change brought, the one that stands in the place of one that went, as of an expanded call. */
export function copyAmong(brought: Readonly<Record<string, Step>>, { kind, pos }: Step): string | undefined {
  return Object.keys(brought).find((id) => brought[id]?.kind === kind && isSameValue(brought[id].pos, pos));
}
