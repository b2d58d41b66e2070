/** Values put in for the names of parameters, wherever they stand in a step's parameters. */

export function substituted(value: unknown, values: ReadonlyMap<string, unknown>): unknown {
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

function parameterOf(value: object): string | null {
  const keys = Object.keys(value);
  return keys.length === 1 && "param" in value && typeof value.param === "string" ? value.param : null;
}

/** A reading names its device by id alone, where an argument is `{device}`. */
function readingOf(reading: readonly unknown[], values: ReadonlyMap<string, unknown>): unknown[] {
  const [device, ...rest] = reading;
  const given = substituted(device, values);
  const named = typeof given === "object" && given !== null && "device" in given ? given.device : given;
  return [named, ...rest];
}
