/** Which functions steps call, and which steps stand for themselves beside the calls of their functions. */
import { textOf, type ProgramDocument } from "./document";
import { ancestors, EVENTS, outermost, readTree, withDescendants } from "./tree";

/** The functions that steps and all inside them call, and those that these call. */
export function calledBy(document: ProgramDocument, ids: Iterable<string>): Set<string> {
  const found = new Set<string>();
  let left = withDescendants(document, ids);
  while (left.size > 0) {
    const calls = [...left].flatMap((id) => document.steps[id] ?? []).filter(({ kind }) => kind === "call");
    const names = calls.map(({ params }) => textOf(params.function));
    const fresh = names.filter((id) => Object.hasOwn(document.functions, id) && !found.has(id));
    for (const id of fresh) found.add(id);
    left = bodiesOf(document, fresh);
  }
  return found;
}

/** All steps of the functions. */
export function bodiesOf(document: ProgramDocument, functions: Iterable<string>): Set<string> {
  const tree = readTree(document);
  const tops = [...functions].flatMap((id) => tree.children(id, "body"));
  return withDescendants(document, tops);
}

/** Leave out those that stand inside another one of them, or in a function that another one of them calls. */
export function standingAlone(document: ProgramDocument, ids: readonly string[]): string[] {
  const topOf = (id: string) => ancestors(document, id).at(-1) ?? "";
  let kept = outermost(document, ids);
  for (const top of new Set(kept.map(topOf))) {
    if (!Object.hasOwn(document.functions, top)) continue;
    const others = kept.filter((id) => topOf(id) !== top);
    if (calledBy(document, others).has(top)) kept = others;
  }
  return kept;
}

/** Behind which of the chosen steps others go: the last that stands alone, if there is one in no function or event. */
export function lastChosen(document: ProgramDocument, ids: readonly string[]): string | null {
  const alone = standingAlone(document, ids);
  const isOwn = (id: string) => {
    const [top = "", branch] = document.steps[ancestors(document, id).at(-2) ?? id]?.place ?? [];
    return branch !== EVENTS.branch && !Object.hasOwn(document.functions, top);
  };
  return alone.findLast(isOwn) ?? alone.at(-1) ?? null;
}
