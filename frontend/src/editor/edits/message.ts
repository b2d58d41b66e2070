/** A message with values in it, as people write it: "Painted {count} boxes". */
import type { Value } from "@/program/document/document";

export interface Insert {
  readonly label: string;
  readonly value: Value;
}

/** The text with its values in braces, as the inserts call them. */
export function messageText(value: Value | undefined, inserts: readonly Insert[]): string {
  if (value === null || value === undefined) return "";
  if (typeof value === "string") return value;
  const labels = new Map(inserts.map((insert) => [JSON.stringify(insert.value), insert.label]));
  const parts = isText(value) ? value.args : [value];
  return parts
    .map((part) => (typeof part === "string" ? part : `{${labels.get(JSON.stringify(part)) ?? "?"}}`))
    .join("");
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

/**
 * What may stand in a message: what is offered, and the values that it has now, so that they survive an edit of the text
 * around them. Each value is there once, and under a label of its own: those that are alike get an id.
 */
export function insertsFor(
  value: Value | undefined,
  offered: readonly Insert[],
  labelOf: (value: Value) => string,
): readonly Insert[] {
  const values = isText(value) ? value.args : [value];
  const own = values.flatMap((part): Insert[] =>
    part === null || part === undefined || typeof part === "string" ? [] : [{ label: labelOf(part), value: part }],
  );
  const once = new Map([...own, ...offered].map((insert) => [JSON.stringify(insert.value), insert]));
  const inserts = [...once.values()].map((insert) => ({ ...insert, label: withoutBraces(insert.label) }));
  const counts = new Map<string, number>();
  for (const { label } of inserts) counts.set(label, (counts.get(label) ?? 0) + 1);
  const taken = new Set<string>();
  return inserts.map((insert) => {
    const alike = (counts.get(insert.label) ?? 0) > 1;
    const label = freeLabel(insert.label, alike ? idIn(insert.value) : null, taken);
    taken.add(label);
    return { ...insert, label };
  });
}

function isText(value: Value | undefined): value is { readonly op: string; readonly args: readonly Value[] } {
  return typeof value === "object" && value !== null && "op" in value && value.op === "text";
}

/** As it can stand in braces. */
function withoutBraces(label: string): string {
  return label.replaceAll("{", "(").replaceAll("}", ")").trim();
}

function freeLabel(label: string, id: string | null, taken: ReadonlySet<string>): string {
  const told = id === null ? label : `${label} (${id})`;
  let free = told;
  for (let count = 2; taken.has(free); count += 1) free = `${told} (${count})`;
  return free;
}

/** The device, place, role or zone of a reading or of what has a place; null for all else. */
function idIn(value: Value): string | null {
  if (typeof value !== "object" || value === null || Array.isArray(value)) return null;
  const { property, at } = value as { property?: unknown; at?: unknown };
  const named: unknown = Array.isArray(property) ? property[0] : (at ?? value);
  if (typeof named === "string") return named;
  const ids = typeof named === "object" && named !== null ? Object.entries(named) : [];
  const found = ids.find(([key, id]) => ["device", "place", "role", "zone"].includes(key) && typeof id === "string");
  return found ? String(found[1]) : null;
}
