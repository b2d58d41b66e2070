/** Conditions as the inspector shows them: comparisons joined by one word, and back to a value. */
import type { Role, Value } from "@/program/document/document";

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

const COMPARED = ["==", "!=", "<", "<=", ">", ">="];

/** Whether the form of property, comparison and value can show it all; what it cannot show is written. */
export function fitsForm(value: Value): boolean {
  if (value === null || typeof value !== "object") return value === null;
  if (!("op" in value)) return "property" in value || "param" in value;
  if (value.op === "and" || value.op === "or") return value.args.every((each) => fitsForm(each) && !isJoined(each));
  return COMPARED.includes(value.op) && isNamed(value.args[0]);
}

function isJoined(value: Value): boolean {
  return value !== null && typeof value === "object" && "op" in value && (value.op === "and" || value.op === "or");
}

function isNamed(value: Value | undefined): boolean {
  if (value === null || value === undefined) return true;
  if (typeof value !== "object") return false;
  return (
    isParameter(value) || ("property" in value && (typeof value.property[0] === "string" || isRole(value.property[0])))
  );
}

function isParameter(value: Value | undefined): boolean {
  return typeof value === "object" && value !== null && "param" in value;
}

function isRole(thing: object): thing is { readonly role: string } {
  return "role" in thing;
}

/** The readings that a value looks at, as device and property, each once; a role that is bound is its device. */
export function readingsOf(
  value: Value,
  roles: Readonly<Record<string, Role>> = {},
): readonly (readonly [string, string])[] {
  const found = new Map<string, readonly [string, string]>();
  const look = (each: Value | undefined): void => {
    if (each === null || each === undefined || typeof each !== "object") return;
    if ("op" in each) each.args.forEach(look);
    if (!("property" in each)) return;
    const [thing, name] = each.property;
    const device = typeof thing === "object" && isRole(thing) ? roles[thing.role]?.device : thing;
    if (typeof device === "string") found.set(`${device}\n${name}`, [device, name]);
  };
  look(value);
  return [...found.values()];
}
