/** A message with values in it, as people write it: "Painted {count} boxes". */
import type { Value } from "@/program/document/document";

export interface Insert {
  readonly label: string;
  readonly value: Value;
}

/** The text with its values in braces; null where the value is no message that can be written so. */
export function messageText(value: Value | undefined, labelOf: (value: Value) => string): string | null {
  if (value === null || value === undefined) return "";
  if (typeof value === "string") return value;
  if (typeof value !== "object" || !("op" in value) || value.op !== "text") return `{${labelOf(value)}}`;
  return value.args.map((part) => (typeof part === "string" ? part : `{${labelOf(part)}}`)).join("");
}

/** Back again: braces around a known label are its value, all else is text; null where nothing is written. */
export function messageFrom(text: string, inserts: readonly Insert[]): Value {
  const known = new Map(inserts.map((insert) => [insert.label, insert.value]));
  const parts: Value[] = [];
  let plain = "";
  for (const piece of text.split(/(\{[^{}]*\})/)) {
    const value = piece.startsWith("{") ? known.get(piece.slice(1, -1).trim()) : undefined;
    if (value === undefined) {
      plain += piece;
      continue;
    }
    if (plain) parts.push(plain);
    parts.push(value);
    plain = "";
  }
  if (plain) parts.push(plain);
  if (parts.length === 0) return null;
  const [only] = parts;
  return parts.length === 1 && typeof only === "string" ? only : { op: "text", args: parts };
}

/** The values that a message has now, so that they survive an edit of the text around them. */
export function insertsOf(value: Value | undefined, labelOf: (value: Value) => string): readonly Insert[] {
  if (typeof value !== "object" || value === null || !("op" in value) || value.op !== "text") return [];
  return value.args
    .filter((part) => typeof part === "object" && part !== null)
    .map((part) => ({ label: labelOf(part), value: part }));
}
