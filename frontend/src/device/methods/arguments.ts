/** What people type for a method's parameters, and the arguments that it makes. Pure. */
import type { DeviceMethod, MethodParameter, Scalar } from "@/api/types";
import { ownEntry } from "@/design/ownEntry";

export type Typed = Readonly<Record<string, string | number | boolean>>;
export type Problem = "missing" | "number" | "below" | "above" | "location";
export type Argument = Scalar | readonly number[];

export type Read =
  | { readonly args: Readonly<Record<string, Argument>> }
  | { readonly problems: Readonly<Record<string, Problem>> };

/** How a form begins: switches are off, everything else is empty. */
export function emptyForm(method: DeviceMethod): Typed {
  return Object.fromEntries(method.parameters.map((each) => [each.name, each.type === "boolean" ? false : ""]));
}

/** The arguments to send; what is left empty and not needed is left out. */
export function readArguments(method: DeviceMethod, typed: Typed): Read {
  const args: Record<string, Argument> = {};
  const problems: Record<string, Problem> = {};
  for (const parameter of method.parameters) {
    const value = ownEntry(typed, parameter.name) ?? "";
    if (value === "" && parameter.required) problems[parameter.name] = "missing";
    if (value === "") continue;
    const read = readOne(parameter, value);
    if ("problem" in read) problems[parameter.name] = read.problem;
    else args[parameter.name] = read.value;
  }
  return Object.keys(problems).length > 0 ? { problems } : { args };
}

function readOne(parameter: MethodParameter, value: Scalar): { value: Argument } | { problem: Problem } {
  if (parameter.type === "number") return readNumber(parameter, Number(value));
  if (parameter.type !== "location") return { value };
  const numbers = readPoint(String(value));
  const fits = numbers.length >= 2 && numbers.length <= 4 && numbers.every(Number.isFinite);
  return fits ? { value: numbers } : { problem: "location" };
}

/**
 * The numbers of a place as people write them; NaN where they can be read in two ways.
 *
 * A comma within a number is a decimal sign where blanks or semicolons part the numbers; without these, commas part
 * them where points are there for the decimals.
 */
function readPoint(text: string): number[] {
  const parts = text
    .replace(/\s+,/g, ",")
    .split(/[\s;]+/)
    .filter(Boolean);
  const bare = parts.map((part) => part.replace(/,$/, ""));
  const hasPoint = text.includes(".");
  if (parts.length === 1) return hasPoint ? (bare[0] ?? "").split(",").map(readWritten) : [NaN];
  const hasDecimalComma = bare.some((part) => part.includes(","));
  const hasPartingComma = parts.some((part, at) => part !== bare[at]);
  if (hasDecimalComma && (hasPartingComma || hasPoint)) return [NaN];
  return bare.map((part) => readWritten(part.replace(",", ".")));
}

function readWritten(text: string): number {
  return /^[+-]?\d+(\.\d*)?$|^[+-]?\.\d+$/.test(text) ? Number(text) : NaN;
}

function readNumber({ minimum, maximum }: MethodParameter, value: number): { value: number } | { problem: Problem } {
  if (!Number.isFinite(value)) return { problem: "number" };
  if (minimum !== null && value < minimum) return { problem: "below" };
  return maximum !== null && value > maximum ? { problem: "above" } : { value };
}
