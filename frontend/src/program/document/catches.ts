/** The catches of a Try: `catch` with its `kinds`, and further ones, numbered; each is there by a parameter of its own. */
import { fieldsOf } from "../kinds";
import type { Step } from "./document";

const FIRST = "catch";
const MOST = fieldsOf("try").find((field) => field.name === "kinds")?.numbered ?? 1;
const ALL = Array.from({ length: MOST }, (_, index) => (index === 0 ? FIRST : `${FIRST}${index + 1}`));

type Params = Step["params"];

/** The branches of the catches that a Try has, in the order in which they are tried. */
export function catchesOf(params: Params): readonly string[] {
  return ALL.filter((branch) => (branch === FIRST ? params.catch !== false : Array.isArray(params[kindsOf(branch)])));
}

/** The parameter that says what a catch takes. */
export function kindsOf(branch: string): string {
  return `kinds${branch.slice(FIRST.length)}`;
}

/** Whether a branch of a Try, or where one could be, is a catch. */
export function isCatch(branch: string | undefined): boolean {
  return branch !== undefined && ALL.includes(branch);
}

/** A parameter with the value that it gets. */
export type Change = readonly [name: string, value: unknown];

/**
 * What makes one more: behind those that are there, as long as there is room, else in a gap; null when all are there.
 * Two who add one at the same moment must not take the same number, for then there would be one: who is `turn`th of
 * those at the Try leaves the numbers of those before free.
 */
export function addedCatch(params: Params, turn = 0): Change | null {
  const there = catchesOf(params);
  const behind = ALL.slice(ALL.indexOf(there.at(-1) ?? "") + 1);
  const branch = behind[Math.min(turn, behind.length - 1)] ?? ALL.find((each) => !there.includes(each));
  if (branch === undefined) return null;
  return branch === FIRST ? [FIRST, null] : [kindsOf(branch), []];
}

/** What takes a catch away. */
export function removedCatch(branch: string): Change {
  return branch === FIRST ? [FIRST, false] : [kindsOf(branch), null];
}
