/** A decision carried out as one entry to undo, or the reason why not, in words. */
import type { Decision } from "../model/edits";
import type { OpenProgram } from "../state/context";
import { say } from "../state/ui";

export function settle({ apply, t }: OpenProgram, decision: Decision): boolean {
  if ("edits" in decision) {
    apply(decision.edits);
    return true;
  }
  say(t(`refused.${decision.refused}`));
  return false;
}
