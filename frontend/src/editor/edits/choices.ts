/** The condition by which a role's robot is chosen, as its form shows it: one reading of the robot, a sign, a value. */
import type { Value } from "@/program/document/document";

export interface Choice {
  readonly reading: string;
  readonly sign: string;
  readonly value: string | number | boolean | null;
}

const SIGNS = ["==", "!=", "<", "<=", ">", ">="];

const TRUTHS = new Map([
  ...["true", "yes", "ja"].map((word) => [word, true] as const),
  ...["false", "no", "nein"].map((word) => [word, false] as const),
]);

/** What a condition says; null where it is more than the form can show, or of another robot. */
export function choiceOf(where: Value | undefined, role: string): Choice | null {
  if (typeof where !== "object" || where === null || !("op" in where) || !SIGNS.includes(where.op)) return null;
  const [left, right = null] = where.args;
  if (typeof left !== "object" || left === null || !("property" in left)) return null;
  const [owner, reading] = left.property;
  if (typeof owner !== "object" || !("role" in owner) || owner.role !== role) return null;
  return typeof right === "object" && right !== null ? null : { reading, sign: where.op, value: right };
}

export function choiceValue({ reading, sign, value }: Choice, role: string): Value {
  return { op: sign, args: [{ property: [{ role }, reading] }, value] };
}

/** What is typed, as the reading is: a number, with a comma too, yes or no, or a text; null while it is none. */
export function typedValue(text: string, type: string | undefined): Choice["value"] {
  if (type === "boolean") return TRUTHS.get(text.trim().toLowerCase()) ?? null;
  if (type !== "number") return text.trim() || null;
  const number = Number(text.trim().replace(",", "."));
  return text.trim() === "" || !Number.isFinite(number) ? null : number;
}
