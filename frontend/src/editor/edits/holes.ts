/** Devices and places of another site in steps that are put into this one: which they are, what they must be able to
do, what fits best here, and the steps with others in their stead or with a hole where nobody is. Pure. */
import { textOf, type Role, type Step, type Zone } from "@/program/document/document";
import { operatedRole, roleOfStep } from "@/program/operation";
import type { SiteDevice } from "@/program/surroundings";
import type { Edit } from "./edits";

export interface Stranger {
  readonly kind: "device" | "place";
  readonly id: string;
  /** As people called it where it comes from, or its id. */
  readonly name: string;
  readonly needs: Needs;
}

/** What the steps want of a device. */
export interface Needs {
  readonly robot: boolean;
  readonly methods: readonly string[];
  readonly gives: readonly string[];
  readonly takes: readonly string[];
  readonly readings: readonly string[];
}

/** What stands in a stranger's stead; null leaves a hole. */
export type Chosen = ReadonlyMap<string, string | null>;

interface Known {
  readonly devices: ReadonlySet<string>;
  readonly places: ReadonlySet<string>;
  /** Names from where the steps come from, by id. */
  readonly names: Readonly<Record<string, string>>;
}

const NO_NEEDS: Needs = { robot: false, methods: [], gives: [], takes: [], readings: [] };

/** Those that the edits name and that are not known here, in the order of their first mention. */
export function strangersIn(edits: readonly Edit[], known: Known): Stranger[] {
  const found = new Map<string, Stranger>();
  const meet = (kind: Stranger["kind"], id: string, needs: Partial<Needs> = {}) => {
    if ((kind === "device" ? known.devices : known.places).has(id)) return;
    const before = found.get(id)?.needs ?? NO_NEEDS;
    found.set(id, { kind, id, name: known.names[id] ?? id, needs: joined(before, needs) });
  };
  const roles = rolesOf(edits);
  for (const [, role] of roles) if (role.device) meet("device", role.device, { robot: true });
  for (const door of doorsOf(edits)) meet("device", door, { methods: ["open"] });
  for (const step of stepsOf(edits)) meetStep(step, roles, meet);
  return [...found.values()];
}

type Meet = (kind: Stranger["kind"], id: string, needs?: Partial<Needs>) => void;

function meetStep(step: Step, roles: ReadonlyMap<string, Role>, meet: Meet): void {
  const { params } = step;
  const own = roles.get(roleOfStep(step) ?? operatedRole(params.device) ?? "")?.device;
  const objects = textOf(params.object) ? [textOf(params.object)] : [];
  const device = (value: unknown) => textOf((value as { device?: unknown } | null | undefined)?.device);
  const methods = textOf(params.method) ? [textOf(params.method)] : [];
  if (own && methods.length > 0) meet("device", own, { robot: true, methods });
  if (step.kind === "operate" && device(params.device)) meet("device", device(params.device), { methods });
  for (const name of ["source", "at"] as const)
    if (device(params[name]) && step.kind !== "drop") meet("device", device(params[name]), { gives: objects });
  for (const name of ["target", "at"] as const)
    if (device(params[name]) && step.kind !== "pick") meet("device", device(params[name]), { takes: objects });
  walk(params, (key, value) => {
    if ((key === "device" || key === "place") && typeof value === "string") meet(key, value);
    if (key === "property" && isReading(value)) meet("device", value[0], { readings: [value[1]] });
  });
}

function isReading(value: unknown): value is [string, string] {
  return Array.isArray(value) && typeof value[0] === "string" && typeof value[1] === "string";
}

function joined(one: Needs, other: Partial<Needs>): Needs {
  const both = (name: "methods" | "gives" | "takes" | "readings") => [
    ...new Set([...one[name], ...(other[name] ?? [])]),
  ];
  return {
    robot: one.robot || (other.robot ?? false),
    methods: both("methods"),
    gives: both("gives"),
    takes: both("takes"),
    readings: both("readings"),
  };
}

function rolesOf(edits: readonly Edit[]): ReadonlyMap<string, Role> {
  return new Map(
    edits.flatMap((edit) => (edit.do === "set_role" && edit.value ? [[edit.id, edit.value] as const] : [])),
  );
}

function doorsOf(edits: readonly Edit[]): string[] {
  return edits.flatMap((edit) => (edit.do === "set_zone" && edit.value?.door ? [edit.value.door] : []));
}

function stepsOf(edits: readonly Edit[]): Step[] {
  return edits.flatMap((edit) => (edit.do === "add_step" ? [edit.step] : []));
}

function walk(value: unknown, see: (key: string, value: unknown) => void): void {
  if (typeof value !== "object" || value === null) return;
  for (const [key, inner] of Object.entries(value)) {
    see(key, inner);
    walk(inner, see);
  }
}

/** Those that may stand in, best first: who can all that the steps want, then who is called alike. */
export function matchesFor({ needs, name, id }: Stranger, devices: readonly SiteDevice[]): SiteDevice[] {
  const suited = devices.filter((each) => (each.kind === "robot") === needs.robot && each.lifecycle !== "retired");
  const rated = suited.map((device) => ({ device, rate: rateOf(device, needs, `${name} ${id}`) }));
  return rated.sort((one, other) => other.rate - one.rate).map(({ device }) => device);
}

/** Whether the device can all that the steps want. */
export function canAll(device: SiteDevice, needs: Needs): boolean {
  return rateOf(device, needs, "") >= 0 && missingOf(device, needs) === 0;
}

function missingOf(device: SiteDevice, { methods, gives, takes, readings }: Needs): number {
  const lacks = (wanted: readonly string[], had: readonly string[]) => {
    const names = had.map(bareName);
    return wanted.filter((each) => !names.includes(bareName(each))).length;
  };
  return (
    lacks(
      methods,
      device.methods.map((each) => each.name),
    ) +
    lacks(gives, device.gives) +
    lacks(takes, device.takes) +
    lacks(
      readings,
      device.properties.map((each) => each.name),
    )
  );
}

/** A script writes cure_paint what the device calls curePaint. */
function bareName(name: string): string {
  return name.replaceAll("_", "").toLowerCase();
}

const MISSING = 100;

function rateOf(device: SiteDevice, needs: Needs, called: string): number {
  const words = wordsIn(called);
  const alike = wordsIn(`${device.name} ${device.id} ${device.device_class}`).filter((word) => words.includes(word));
  return alike.length - MISSING * missingOf(device, needs);
}

function wordsIn(text: string): string[] {
  return [
    ...new Set(
      text
        .replace(/(\p{Ll})(\p{Lu})/gu, "$1 $2")
        .toLowerCase()
        .match(/\p{L}+/gu) ?? [],
    ),
  ];
}

/** The edits with what was chosen; where nothing was, what named the stranger is left out, for people to fill. */
export function withChosen(edits: readonly Edit[], chosen: Chosen): Edit[] {
  return edits.map((edit): Edit => {
    if (edit.do === "add_step")
      return { ...edit, step: { ...edit.step, params: filledParams(edit.step.params, chosen) } };
    if (edit.do === "set_param") return { ...edit, value: filled(edit.value, chosen) ?? null };
    if (edit.do === "set_role" && edit.value) return { ...edit, value: withDevice(edit.value, "device", chosen) };
    if (edit.do === "set_zone" && edit.value) return { ...edit, value: withDevice(edit.value, "door", chosen) };
    return edit;
  });
}

/** A role or a zone with what was chosen for the device that it names. */
function withDevice<T extends Role | Zone>(value: T, key: keyof T, chosen: Chosen): T {
  const other = chosen.get(String(value[key]));
  if (other === undefined) return value;
  return Object.fromEntries(
    Object.entries({ ...value, [key]: other }).filter(([name]) => name !== key || other !== null),
  ) as T;
}

function filledParams(params: Step["params"], chosen: Chosen): Step["params"] {
  const entries = Object.entries(params).map(([name, value]) => [name, filled(value, chosen)] as const);
  return Object.fromEntries(entries.filter(([, value]) => value !== undefined));
}

/** Undefined where it is a hole: an operation with a hole in it is one as a whole, a list goes on without it. */
function filled(value: unknown, chosen: Chosen): unknown {
  if (Array.isArray(value)) return value.map((each) => filled(each, chosen)).filter((each) => each !== undefined);
  if (typeof value !== "object" || value === null) return value;
  const named = strangerOf(value, chosen);
  if (named) return named.other === null ? undefined : named.other;
  if ("op" in value && "args" in value && Array.isArray(value.args)) {
    const args = value.args.map((each) => filled(each, chosen));
    return args.includes(undefined) ? undefined : { ...value, args };
  }
  const entries = Object.entries(value).map(([key, inner]) => [key, filled(inner, chosen)] as const);
  return Object.fromEntries(entries.filter(([, inner]) => inner !== undefined));
}

/** What stands in for a value that names a stranger; null where the value names none. */
function strangerOf(value: object, chosen: Chosen): { readonly other: object | null } | null {
  for (const key of ["device", "place"] as const) {
    const id = (value as Record<string, unknown>)[key];
    const other = typeof id === "string" ? chosen.get(id) : undefined;
    if (other !== undefined) return { other: other === null ? null : { ...value, [key]: other } };
  }
  if (!("property" in value) || !isReading(value.property)) return null;
  const [id, ...rest] = value.property;
  const other = chosen.get(id);
  return other === undefined ? null : { other: other === null ? null : { ...value, property: [other, ...rest] } };
}
