/** What a catch of a Try is called: by what it takes, where there are several. */
import { catchesOf, kindsOf } from "../document/catches";
import type { Step } from "../document/document";
import type { Translate } from "./stepWords";

/** "timed out +1", "any", or "the rest"; null for the only catch of a Try. */
export function takenBy(branch: string, { params }: Step, t: Translate): string | null {
  const there = catchesOf(params);
  if (there.length < 2 || !there.includes(branch)) return null;
  const kinds = params[kindsOf(branch)];
  const [first, ...more] = Array.isArray(kinds) ? kinds.map(String) : [];
  if (first === undefined) return t(there[0] === branch ? "caught.any" : "caught.rest");
  const word = t(`caught.${first}`);
  return more.length > 0 ? `${word} +${more.length}` : word;
}
