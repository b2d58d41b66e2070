/** The fields of a change in words: what each is called, what stood there and what stands there now. Pure. */
import type { ConstructChange, ValueChange } from "@/api/types";
import { type FieldRecord, kindOf } from "@/program/kinds";
import type { Place, ProgramDocument, Step, Value } from "@/program/document/document";
import { durationText, placeName, roleName, type Speaker, valueText } from "@/program/words/stepWords";

export interface FieldLine {
  readonly key: string;
  readonly label: string;
  /** Null where nothing stood, or stands. */
  readonly old: string | null;
  readonly new: string | null;
  readonly path: readonly string[];
}

/** A side of the comparison, with the numbers of its steps. */
export interface SideWords {
  readonly speaker: Speaker;
  readonly numbers: Readonly<Record<string, string>>;
}

type Say = (key: string, values?: Record<string, unknown>) => string;

export function fieldLines(change: ConstructChange, old: SideWords, next: SideWords, say: Say): FieldLine[] {
  return change.changes.map((each) => {
    const name = fieldName(each);
    const known = name === null ? "" : say(`compare.field.${name}`, { defaultValue: "" });
    return {
      key: each.path.join("/"),
      label: known || each.path.at(-1) || "",
      old: "old" in each ? valueWords(each, each.old, change, old, say) : null,
      new: "new" in each ? valueWords(each, each.new, change, next, say) : null,
      path: each.path,
    };
  });
}

/** A field as the catalogue names it; null for arguments of a method or a function, which have names of their own. */
function fieldName({ path }: ValueChange): string | null {
  if (path[0] !== "steps") return path.at(-1) ?? "";
  return path[3] === "args" && path.length > 4 ? null : (path[3] ?? path[2] ?? "");
}

function valueWords(field: ValueChange, value: unknown, change: ConstructChange, side: SideWords, say: Say): string {
  if (value === null || value === undefined) return say("compare.none");
  const { speaker } = side;
  const step = change.root === "steps" ? speaker.document.steps[change.id] : undefined;
  if (change.root === "steps" && field.path[2] === "place") return placeInOrder(value, change.id, side, say);
  if (step && field.path[2] === "params") return paramWords(field.path[3] ?? "", value, step, speaker, say);
  return plainWords(value, speaker, say);
}

/** "2", or where it stands without a number. */
function placeInOrder(value: unknown, id: string, { numbers, speaker }: SideWords, say: Say): string {
  const number = numbers[id];
  const parent = Array.isArray(value) ? String(value[0]) : "";
  const inside = numbers[parent] ?? textOf(speaker.document.functions[parent]?.name);
  if (!number) return say("compare.joined_to_nothing");
  return inside ? say("compare.place_inside", { number, parent: inside }) : number;
}

function paramWords(name: string, value: unknown, step: Step, speaker: Speaker, say: Say): string {
  const fields = kindOf(step.kind).forms.flatMap((form) => form.fields ?? []);
  const field = fields.find((each) => each.name === name);
  if (name === "function") return textOf(speaker.document.functions[String(value)]?.name) || String(value);
  if (name === "zone") return textOf(speaker.document.zones[String(value)]?.name) || String(value);
  if (field?.type === "role" || name === "role") return roleName(String(value), speaker);
  if (field && isSeconds(field, value)) return durationText(value);
  return plainWords(value, speaker, say);
}

function isSeconds(field: FieldRecord, value: unknown): value is number {
  return field.wanted === "time" && typeof value === "number";
}

/** A value as a step says it; what it has no words for, as it is written. */
function plainWords(value: unknown, speaker: Speaker, say: Say): string {
  if (typeof value === "boolean") return say(value ? "compare.yes" : "compare.no");
  if (Array.isArray(value)) {
    if (value.length === 0) return say("compare.none");
    return value.every((each) => typeof each !== "object")
      ? value.map(String).join(", ")
      : say("compare.parts", { count: value.length });
  }
  const said = placeName(value as Place, speaker) ?? valueText(value as Value, speaker);
  return said === null || said === "?" ? JSON.stringify(value) : said;
}

function textOf(value: unknown): string {
  return typeof value === "string" ? value : "";
}

/** What a construct that is no step is called. */
export function otherName(change: Pick<ConstructChange, "root" | "id">, documents: readonly ProgramDocument[]): string {
  if (change.root === "steps" || change.root === "program") return "";
  for (const document of documents) {
    const name = (document[change.root][change.id] as { name?: unknown } | undefined)?.name;
    if (typeof name === "string" && name) return name;
  }
  return change.id;
}
