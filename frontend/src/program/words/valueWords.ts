/** Values and places as people read them. */
import { ownEntry } from "@/design/ownEntry";
import { withUnit as withSign } from "@/i18n/format";
import { unitSign } from "@/i18n/units";
import type { Place, ProgramDocument, Value } from "../document/document";
import { DEFAULT_ROLE, operatedRole } from "../operation";
import type { Surroundings } from "../surroundings";

/** A translator: catalogue key and values to text. */
export type Translate = (key: string, values?: Record<string, unknown>) => string;

export interface Speaker {
  readonly t: Translate;
  readonly surroundings: Surroundings;
  readonly document: ProgramDocument;
  /** Readings are said with their device, where the drawing does not show it. */
  readonly full?: boolean;
}

/** A place's name; null where it is not entered. */
export function placeName(place: Place | null | undefined, speaker: Speaker): string | null {
  if (typeof place !== "object" || place === null) return null;
  if ("device" in place) return deviceName(place.device, speaker);
  if ("place" in place) return speaker.surroundings.places.get(place.place)?.name ?? place.place;
  if ("point" in place) return `${place.point[0]}, ${place.point[1]}\u202fm`.replaceAll("-", "−");
  const role = operatedRole(place);
  if (role !== null) return roleName(role, speaker);
  return "param" in place ? place.param : null;
}

/** A robot of the program as people call it. */
export function roleName(role: string, { document, t }: Speaker): string {
  return ownEntry(document.roles, role)?.name ?? (role === DEFAULT_ROLE ? t("role.default") : role);
}

function deviceName(id: string, speaker: Speaker): string {
  return speaker.surroundings.devices.get(id)?.name ?? id;
}

/** A value as people read it; null where it is not entered. */
export function valueText(value: Value | undefined, speaker: Speaker): string | null {
  return value === null || value === undefined || value === "" ? null : sayValue(value, speaker, 0);
}

const SIGNS: Readonly<Record<string, string>> = {
  "==": "=",
  "!=": "≠",
  "<=": "≤",
  ">=": "≥",
  "*": "×",
  "/": "÷",
  "-": "−",
};
const LEVELS: Readonly<Record<string, number>> = {
  or: 1,
  and: 2,
  not: 3,
  "+": 5,
  "-": 5,
  "*": 6,
  "/": 6,
};
const COMPARISON = 4;
const CALLED = ["abs", "round", "min", "max", "distance", "nearest", "count", "now", "len", "nth"];
const WORDS = ["and", "or", "in", "not in"];

/** `around` is how strongly what stands around binds; weaker things go into brackets. */
function sayValue(value: Value, speaker: Speaker, around: number): string {
  if (value === null || value === undefined || value === "") return "?";
  if (typeof value === "number") return String(value).replace("-", "−");
  if (typeof value === "boolean") return speaker.t(value ? "value.true" : "value.false");
  if (typeof value === "string") return value;
  if (isList(value)) return value.map((each) => sayValue(each, speaker, 0)).join(", ");
  if (isNonsense(value)) return "?";
  if ("op" in value) return sayOperation(value.op, value.args, speaker, around);
  return sayAtom(value, speaker);
}

function isList(value: Value): value is readonly Value[] {
  return Array.isArray(value);
}

/** Others may have written anything: what is no value reads as missing. */
function isNonsense(value: object): boolean {
  const { op, args, quantity, at, property, param, zone } = value as Record<string, unknown>;
  if (op !== undefined) return !Array.isArray(args);
  const lists = Array.isArray(quantity) || Array.isArray(property);
  return !lists && typeof (param ?? zone) !== "string" && (typeof at !== "object" || at === null);
}

type Atom = Exclude<Extract<Value, object>, readonly Value[] | { readonly op: string }>;

function sayAtom(value: Atom, speaker: Speaker): string {
  if ("param" in value) return value.param;
  if ("quantity" in value) return withUnit(String(value.quantity[0]).replace("-", "−"), value.quantity[1]);
  if ("zone" in value) return ownEntry(speaker.document.zones, value.zone)?.name ?? value.zone;
  if ("at" in value) return sayLocation(value.at, speaker);
  const [device, name] = value.property;
  if (typeof device === "object") return `${"role" in device ? roleName(device.role, speaker) : device.param} ${name}`;
  return speaker.full ? `${deviceName(device, speaker)} ${name}` : name;
}

function sayLocation(at: Place | { readonly role: string }, speaker: Speaker): string {
  if ("role" in at) return ownEntry(speaker.document.roles, at.role)?.name ?? speaker.t("role.default");
  return placeName(at, speaker) ?? "?";
}

function sayOperation(op: string, args: readonly Value[], speaker: Speaker, around: number): string {
  if (op === "list") return args.length === 0 ? speaker.t("value.no_items") : sayValue(args, speaker, 0);
  if (op === "text") return args.map((each) => sayValue(each, speaker, 0)).join("");
  if (CALLED.includes(op)) {
    const [first = "?", ...rest] = args.map((each) => sayValue(each, speaker, 0));
    return speaker.t(`value.${op}`, { first, rest: rest.join(", "), all: [first, ...rest].join(", ") });
  }
  const level = ownEntry(LEVELS, op) ?? COMPARISON;
  const [only] = args;
  if (args.length === 1 && only !== undefined) {
    const inner = sayValue(only, speaker, level);
    return op === "not" ? bracketed(`${speaker.t("value.not")} ${inner}`, level < around) : `−${inner}`;
  }
  const sign = WORDS.includes(op) ? speaker.t(`value.${op.replace(" ", "_")}`) : (ownEntry(SIGNS, op) ?? op);
  const sides = args.map((each, index) => sayValue(each, speaker, index === 0 ? level : level + 0.5));
  return bracketed(sides.join(` ${sign} `), level < around && !chains(op, level, around));
}

/** "a and b and c" reads without brackets. */
function chains(op: string, level: number, around: number): boolean {
  return (op === "and" || op === "or" || op === "+") && around === level + 0.5;
}

function bracketed(text: string, needed: boolean): string {
  return needed ? `(${text})` : text;
}

/** A number behind which stands its unit, as a description names it. */
export function withUnit(text: string, unit: string | null | undefined): string {
  return withSign(text, unitSign(unit));
}

/** Seconds as "1 min 6 s". */
export function durationText(seconds: number): string {
  const whole = Math.round(seconds * 10) / 10;
  if (whole < 60) return `${whole}\u202fs`;
  const minutes = Math.floor(whole / 60);
  const rest = Math.round(whole - minutes * 60);
  return rest ? `${minutes}\u202fmin ${rest}\u202fs` : `${minutes}\u202fmin`;
}
