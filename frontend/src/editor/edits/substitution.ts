/** Values put in for names, and ids for other ids, wherever a step's parameters have them. */
import { textOf, type ProgramDocument, type Step } from "@/program/document/document";
import { namesOfLoops, settingFields } from "./scopes";

/**
 * The parameters of a step of the document with values for the names that it reads. Where the value is another name, what sets the
 * old one sets that. Names that a loop around the step gives are the loop's, and stay.
 */
export function paramsWith(
  document: ProgramDocument,
  id: string,
  values: ReadonlyMap<string, unknown>,
): Step["params"] {
  const step = document.steps[id];
  if (!step) return {};
  const ofLoops = namesOfLoops(document, id);
  const meant = new Map([...values].filter(([name]) => !ofLoops.has(name)));
  const params = substituted(step.params, meant) as Step["params"];
  const renamed = settingFields(step).flatMap((field) => {
    const name = parameterOf(meant.get(textOf(step.params[field])));
    return name === null ? [] : [[field, name] as const];
  });
  return { ...params, ...Object.fromEntries(renamed) };
}

function substituted(value: unknown, values: ReadonlyMap<string, unknown>): unknown {
  if (Array.isArray(value)) return value.map((item) => substituted(item, values));
  if (typeof value !== "object" || value === null) return value;
  const name = parameterOf(value);
  if (name !== null && values.has(name)) return values.get(name);
  return Object.fromEntries(
    Object.entries(value).map(([key, item]) => [
      key,
      key === "property" && Array.isArray(item) ? readingOf(item, values) : substituted(item, values),
    ]),
  );
}

function parameterOf(value: unknown): string | null {
  if (typeof value !== "object" || value === null || Object.keys(value).length !== 1) return null;
  return "param" in value && typeof value.param === "string" ? value.param : null;
}

/** A reading names its device by id alone, where an argument is `{device}`. */
function readingOf(reading: readonly unknown[], values: ReadonlyMap<string, unknown>): unknown[] {
  const [device, ...rest] = reading;
  const given = substituted(device, values);
  const named = typeof given === "object" && given !== null && "device" in given ? given.device : given;
  return [named, ...rest];
}

/** The keys of parameters and values that hold an id of the program. */
export type IdKey = "function" | "role" | "zone";
const ID_KEYS: readonly string[] = ["function", "role", "zone"] satisfies IdKey[];

/** Parameters with other ids for functions, roles and zones; what arguments are called does not count. */
export function paramsWithIds(params: Step["params"], other: (id: string, key: IdKey) => string): Step["params"] {
  return Object.fromEntries<unknown>(
    Object.entries(params).map(([name, value]) => {
      if (name !== "args" || typeof value !== "object" || value === null) return [name, idIn(name, value, other)];
      return [name, Object.fromEntries(Object.entries(value).map(([each, given]) => [each, withIds(given, other)]))];
    }),
  );
}

function idIn(key: string, value: unknown, other: (id: string, key: IdKey) => string): unknown {
  return ID_KEYS.includes(key) && typeof value === "string" ? other(value, key as IdKey) : withIds(value, other);
}

/** A value with other ids in it. */
export function withIds(value: unknown, other: (id: string, key: IdKey) => string): unknown {
  if (Array.isArray(value)) return value.map((item) => withIds(item, other));
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, idIn(key, item, other)]));
}
