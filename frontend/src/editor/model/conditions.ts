/** Conditions as the inspector shows them: comparisons joined by one word, and back to a value. */
import type { Value } from "./types";

export interface Comparison {
  readonly left: Value;
  readonly sign: string;
  readonly right: Value;
}

export interface Comparisons {
  readonly joiner: "and" | "or";
  readonly comparisons: readonly Comparison[];
}

/** A value that is not a comparison counts as one that asks whether it is true. */
export function splitComparisons(value: Value): Comparisons {
  if (value === null || value === undefined) return { joiner: "and", comparisons: [] };
  if (typeof value === "object" && "op" in value) {
    if (value.op === "and" || value.op === "or")
      return {
        joiner: value.op,
        comparisons: value.args.flatMap((each) =>
          each === null ? [{ left: null, sign: "==", right: null }] : splitComparisons(each).comparisons,
        ),
      };
    const [left = null, right = null] = value.args;
    return { joiner: "and", comparisons: [{ left, sign: value.op, right }] };
  }
  return { joiner: "and", comparisons: [{ left: value, sign: "==", right: true }] };
}

export function joinComparisons(comparisons: readonly Comparison[], joiner: "and" | "or"): Value {
  const values = comparisons.map((each): Value => {
    if (each.left === null && each.right === null) return null;
    return { op: each.sign, args: [each.left, each.right] };
  });
  const [only = null] = values;
  return values.length > 1 ? { op: joiner, args: values } : only;
}
