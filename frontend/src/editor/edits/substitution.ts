/** Values put in for names, wherever a step's parameters read or set them. */
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
