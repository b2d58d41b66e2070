/** What a step's chip says, put into words once for as long as nothing of it has changed. */
import type { Step } from "../document/document";
import { chipText, conditionText, type Speaker, type TextPart } from "./stepWords";

export interface ChipWords {
  readonly parts: readonly TextPart[];
  /** What an If or a While asks. */
  readonly condition: readonly TextPart[] | null;
}

/** All that words depend on beside their step. */
type Around = readonly unknown[];

const known = new WeakMap<Step, { readonly around: Around; readonly words: ChipWords }>();

/** A step of a document is another object once it has changed, and so are the names of others. */
export function wordsOf(step: Step, speaker: Speaker): ChipWords {
  const { document, surroundings, t } = speaker;
  const around = [t, surroundings, document.roles, document.zones, document.functions];
  const before = known.get(step);
  if (before?.around.every((each, at) => each === around[at])) return before.words;
  const condition = step.kind === "if" || step.kind === "while" ? conditionText(step, speaker) : null;
  const words = { parts: chipText(step, speaker), condition };
  known.set(step, { around, words });
  return words;
}
