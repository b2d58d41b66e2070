/** What stands for itself in a field that wants it: numbers, yes and no, texts without quotation marks. */
import type { Value } from "@/program/document/document";

export interface Wanted {
  /** number, boolean, text and the like; undefined where anything may stand. */
  readonly type: string | undefined;
  /** Values to choose from, where only these are understood. */
  readonly options: readonly (string | number | boolean)[];
  /** Names that the line may use; a text of the same letters needs its quotation marks. */
  readonly names: ReadonlySet<string>;
  readonly yes: string;
  readonly no: string;
  /** Whether people here write 2,5 for two and a half. */
  readonly comma: boolean;
}

const NUMERIC = /^(number|integer|float|double|decimal|int|time|duration)$/i;
const NUMBER = /^-?\d+(\.\d+)?$/;
const WITH_COMMA = /^-?\d+,\d+$/;
const BARE = /^\p{L}[\p{L}\p{N} -]*$/u;
const SIMPLE = /^[^"\\\p{C}]*$/u;

export function isNumeric(type: string | undefined): boolean {
  return type !== undefined && NUMERIC.test(type);
}

/** The value of what needs no reading; null where the line must be read. */
export function readPlain(text: string, wanted: Wanted): { readonly value: Value } | null {
  const line = text.trim();
  if (line === "") return { value: null };
  if (wanted.names.has(line)) return null;
  const option = wanted.options.find((each) => String(each) === line);
  if (option !== undefined) return { value: option };
  if (wanted.type === "boolean") return readBoolean(line, wanted);
  if (NUMBER.test(line)) return { value: Number(line) };
  if (wanted.comma && WITH_COMMA.test(line)) return { value: Number(line.replace(",", ".")) };
  return wantsText(wanted) && BARE.test(line) ? { value: line } : null;
}

function readBoolean(line: string, { yes, no }: Wanted): { readonly value: Value } | null {
  const word = line.toLowerCase();
  if (word === yes.toLowerCase() || word === "true") return { value: true };
  return word === no.toLowerCase() || word === "false" ? { value: false } : null;
}

/** The line for a value that needs no printing; null where only the server can write it. */
export function writePlain(value: Value | undefined, wanted: Wanted): string | null {
  if (value === null || value === undefined) return "";
  if (typeof value === "number") return String(value);
  if (typeof value === "boolean") return wanted.type === "boolean" ? booleanWord(value, wanted) : pythonWord(value);
  if (typeof value !== "string") return null;
  const bare = wanted.options.includes(value) || (wantsText(wanted) && BARE.test(value));
  if (bare && !wanted.names.has(value)) return value;
  return SIMPLE.test(value) ? `"${value}"` : null;
}

function pythonWord(value: boolean): string {
  return value ? "True" : "False";
}

function booleanWord(value: boolean, { yes, no, names }: Wanted): string {
  const word = value ? yes : no;
  return names.has(word) ? pythonWord(value) : word;
}

function wantsText({ type }: Wanted): boolean {
  return type !== undefined && type !== "boolean" && !isNumeric(type);
}

/** What can be chosen, as it is written. */
export function choicesOf(wanted: Wanted): readonly string[] {
  const values = wanted.type === "boolean" ? [true, false] : wanted.options;
  return values.flatMap((value) => writePlain(value, wanted) ?? []);
}
