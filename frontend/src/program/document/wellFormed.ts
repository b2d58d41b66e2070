/** A document in which everything has its shape, whatever somebody wrote into it: the rules of the server's
 * `editor/language/reading/well_formed.py`, which says in the diagnostics what was left out. */
import type { FunctionDefinition, Parameter, Position, ProgramDocument, Role, Step, Zone } from "./document";

type Json = Readonly<Record<string, unknown>>;
/** A value as it fits: the same one where it does, undefined where nothing of it does. */
type Shape = (value: unknown) => unknown;
type Fields = Readonly<Record<string, Shape>>;

/** No site is as large, in metres; drawing further away takes all memory. */
const FURTHEST = 1e5;
const LARGEST = 1e15;

const text: Shape = (value) => (typeof value === "string" ? value : undefined);
const number: Shape = (value) => (typeof value === "number" && Math.abs(value) <= LARGEST ? value : undefined);
const point: Shape = (value) => (isPoint(value) ? value : undefined);

function listOf(shape: Shape): Shape {
  return (value) => {
    if (!Array.isArray(value)) return undefined;
    const given: readonly unknown[] = value;
    const fitting = given.map(shape);
    return fitting.every((each, at) => each === given[at]) ? given : fitting.filter((each) => each !== undefined);
  };
}

function objectOf(fields: Fields): Shape {
  return (value) => (isObject(value) ? fitted(value, fields) : undefined);
}

const source: Shape = (value) =>
  isObject(value) && typeof value.library === "string" && number(value.version) !== undefined ? value : undefined;

const TYPED = { type: text, unit: text };
const FIELDS = {
  functions: { name: text, parameters: listOf(objectOf({ name: text, ...TYPED })), result: objectOf(TYPED), source },
  roles: { name: text, device: text, can: listOf(text) },
  parameters: { name: text, ...TYPED },
  zones: { name: text, rule: text, points: listOf(point), speed_m_s: number, door: text },
} as const satisfies Record<string, Fields>;

export type RecordName = keyof typeof FIELDS;
export const RECORDS = Object.keys(FIELDS) as RecordName[];

/** What screens read of each without asking. */
const NEEDED = {
  functions: (id: string) => ({ name: id, parameters: [] }),
  roles: () => ({}),
  parameters: (id: string) => ({ name: id, type: "" }),
  zones: (id: string) => ({ name: id, rule: "", points: [] }),
} as const;

interface Parts {
  readonly functions: Readonly<Record<string, FunctionDefinition>>;
  readonly roles: Readonly<Record<string, Role>>;
  readonly parameters: Readonly<Record<string, Parameter>>;
  readonly zones: Readonly<Record<string, Zone>>;
}

/** The functions, roles, parameters or zones of a document. */
export function readRecords<Name extends RecordName>(name: Name, value: unknown): Parts[Name] {
  const parts = Object.entries(isObject(value) ? value : {}).map(([id, part]) => [
    id,
    { ...NEEDED[name](id), ...present(fitted(isObject(part) ? part : {}, FIELDS[name])) },
  ]);
  return Object.fromEntries(parts) as Parts[Name];
}

export function readStep(value: unknown): Step {
  const { kind, place, pos, params } = isObject(value) ? value : ({} as Json);
  return {
    kind: typeof kind === "string" ? kind : "",
    place: isPlace(place) ? place : null,
    pos: isPoint(pos) ? pos : null,
    params: isObject(params) ? params : {},
  };
}

/** A whole document that did not come from the shared one: of a version, a run, the library. */
export function wellFormed(document: unknown): ProgramDocument {
  const { format, start_pos, steps, ...others } = isObject(document) ? document : ({} as Json);
  return {
    ...readMeta(format, start_pos),
    steps: Object.fromEntries(Object.entries(isObject(steps) ? steps : {}).map(([id, step]) => [id, readStep(step)])),
    functions: readRecords("functions", others.functions),
    roles: readRecords("roles", others.roles),
    parameters: readRecords("parameters", others.parameters),
    zones: readRecords("zones", others.zones),
  };
}

export function readMeta(format: unknown, start: unknown): Pick<ProgramDocument, "format" | "start_pos"> {
  return { format: typeof format === "number" ? format : 2, start_pos: isPoint(start) ? start : null };
}

function fitted(part: Json, fields: Fields): Json {
  const unfit = Object.entries(fields).filter(([field, shape]) => {
    const value = part[field];
    return value !== undefined && value !== null && shape(value) !== value;
  });
  if (unfit.length === 0) return part;
  const changed = Object.fromEntries(unfit.map(([field, shape]) => [field, shape(part[field])]));
  return present({ ...part, ...changed });
}

/** Without what is undefined. */
function present(part: Json): Json {
  return Object.fromEntries(Object.entries(part).filter(([, value]) => value !== undefined));
}

function isObject(value: unknown): value is Json {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

export function isPoint(value: unknown): value is Position {
  return Array.isArray(value) && value.length === 2 && value.every((each) => isNear(each));
}

function isNear(value: unknown): boolean {
  return typeof value === "number" && Math.abs(value) <= FURTHEST;
}

function isPlace(value: unknown): value is [string, string, string] {
  return Array.isArray(value) && value.length === 3 && value.every((each) => typeof each === "string");
}
