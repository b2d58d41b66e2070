/** With how many of its branches a Parallel ends, and what its chip says of that. */
import type { Step } from "../document/document";
import { branchesOf } from "../document/outline";
import type { Translate } from "./valueWords";

export type Ending = "all" | "first" | "some";

export function endingOf(step: Step): Ending {
  const needed = step.params.needed ?? null;
  if (needed === null) return "all";
  return needed === 1 ? "first" : "some";
}

/** "first of 3 ends it", "2 of 3 end it"; null where all must end, as they do where nothing else is said. */
export function endingText(step: Step, t: Translate): string | null {
  const count = branchesOf(step).length;
  const ending = endingOf(step);
  if (ending === "all" || step.params.needed === count) return null;
  const { needed } = step.params;
  return t(`parallel.chip_${ending}`, { count, needed: typeof needed === "number" ? needed : "?" });
}
