/** Faults on purpose as a form has them, what is wrong with them, and how the server is told of them; pure. */
import type { Device } from "@/api/types";
import { isShare } from "@/i18n/units";
import table from "./faultKinds.json";

type Scalar = string | number | boolean;
export type FaultWord = keyof typeof table.kinds;
export const FAULT_WORDS = Object.keys(table.kinds) as FaultWord[];
export const MOST_FAULTS = table.most;
/** When a fault begins. */
export const BEGINNINGS = ["now", "at", "step", "chance"] as const;
export type Beginning = (typeof BEGINNINGS)[number];
type Field = keyof typeof table.ranges;

/** A fault as it is filled in; what its kind does not take is kept and not sent. */
export interface FaultDraft {
  readonly key: string;
  readonly fault: FaultWord;
  readonly device: string | null;
  readonly begins: Beginning;
  readonly at_step: string | null;
  readonly property: string | null;
  readonly value: Scalar | null;
  readonly error: string;
  readonly numbers: Readonly<Partial<Record<Field, number>>>;
}

export interface FaultSurroundings {
  readonly devices: readonly Device[];
  /** The ids of the program's steps. */
  readonly steps: ReadonlySet<string>;
}

/** What is wrong with a field: a word for it, and the least and the most that it may be. */
export interface FieldProblem {
  readonly why: "choose" | "gone" | "number" | "misfit" | "needs_end";
  readonly least?: number;
  readonly most?: number;
}
export type FaultProblems = Readonly<Record<string, FieldProblem>>;

const MORE: readonly Field[] = ["after_s", "percent", "x", "y", "size_m"];
const USUAL = { at_s: 60, nth: 1, odds: 0.1, after_s: 10, percent: 10, size_m: 0.5 };

export function freshFault(fault: FaultWord = "late"): FaultDraft {
  const key = crypto.randomUUID();
  return {
    key,
    fault,
    device: null,
    begins: "now",
    at_step: null,
    property: null,
    value: null,
    error: "",
    numbers: USUAL,
  };
}

/** The words that a kind of fault takes beside its device and its beginning. */
export function wordsOf(fault: FaultWord): readonly string[] {
  const { needs, may } = table.kinds[fault];
  return [...needs, ...may];
}

export const lasts = (fault: FaultWord): boolean => table.kinds[fault].lasts;

/** How a fault of this kind may begin: what lies on the floor does not hang on commands. */
export const beginningsOf = (fault: FaultWord): readonly Beginning[] =>
  fault === "obstacle" ? BEGINNINGS.filter((each) => each !== "chance") : BEGINNINGS;

/** The devices that can have a fault. */
export function devicesFor(fault: FaultWord, devices: readonly Device[]): readonly Device[] {
  const there = devices.filter(({ lifecycle }) => lifecycle === "approved");
  if (fault === "drops") return there.filter(({ kind }) => kind === "robot");
  if (fault === "wrong_value") return there.filter(({ properties }) => properties.length > 0);
  if (fault !== "battery") return there;
  return there.filter(({ kind, properties }) => kind === "robot" && properties.some(saysCharge));
}

/** Whether it says how full a battery is, as the server asks (`vipo_device/protocol/batteries.py`). */
function saysCharge({ name, type, unit }: Device["properties"][number]): boolean {
  return name === "battery" && type === "number" && isShare(unit);
}

/** The fields of a fault that cannot be sent as they are, by their names. */
export function problemsOf(draft: FaultDraft, around: FaultSurroundings): FaultProblems {
  const found: Record<string, FieldProblem> = {};
  if (draft.fault !== "obstacle") {
    const fitting = devicesFor(draft.fault, around.devices);
    if (draft.device === null) found.device = { why: "choose" };
    else if (!fitting.some(({ id }) => id === draft.device)) found.device = { why: "gone" };
  }
  if (draft.begins === "step") {
    if (draft.at_step === null) found.at_step = { why: "choose" };
    else if (!around.steps.has(draft.at_step)) found.at_step = { why: "gone" };
  }
  if (draft.begins === "chance" && lasts(draft.fault) && draft.numbers.for_s === undefined)
    found.for_s = { why: "needs_end" };
  for (const field of numbersAsked(draft)) {
    const problem = outOfRange(field, draft.numbers[field]);
    if (problem) found[field] ??= problem;
  }
  return draft.fault === "wrong_value" ? { ...found, ...readingProblems(draft, around) } : found;
}

function readingProblems(draft: FaultDraft, { devices }: FaultSurroundings): FaultProblems {
  if (draft.property === null) return { property: { why: "choose" } };
  const property = propertyOf(draft, devices);
  if (!property) return { property: { why: "gone" } };
  const wanted = property.type === "number" || property.type === "boolean" ? property.type : "string";
  if (draft.value === null || draft.value === "") return { value: { why: "choose" } };
  return typeof draft.value === wanted ? {} : { value: { why: "misfit" } };
}

export function propertyOf({ device, property }: FaultDraft, devices: readonly Device[]) {
  return devices.find(({ id }) => id === device)?.properties.find(({ name }) => name === property);
}

/** The numbers that a fault is sent with; those without a value only where they are needed. */
function numbersAsked(draft: FaultDraft): readonly Field[] {
  const { at_s, for_s, size_m } = draft.numbers;
  const own = MORE.filter((field) => wordsOf(draft.fault).includes(field));
  return [
    ...(draft.begins === "at" ? (["at_s"] as const) : []),
    ...(draft.begins === "step" ? (["nth"] as const) : []),
    ...(draft.begins === "chance" ? (["odds"] as const) : []),
    ...own.filter((field) => field !== "size_m" || size_m !== undefined),
    ...(lasts(draft.fault) && for_s !== undefined ? (["for_s"] as const) : []),
  ].filter((field) => field !== "at_s" || draft.begins === "at" || at_s !== undefined);
}

function outOfRange(field: Field, value: number | undefined): FieldProblem | null {
  const [least = 0, most = 0] = table.ranges[field];
  const whole = field !== "nth" || Number.isInteger(value);
  if (value !== undefined && Number.isFinite(value) && value >= least && value <= most && whole) return null;
  const percent = field === "odds" ? 100 : 1;
  return { why: "number", least: field === "odds" ? 1 : least, most: most * percent };
}

/** A fault as the server takes it (docs/testing-programs.md); only of a draft without problems. */
export function entryOf(draft: FaultDraft): Readonly<Record<string, Scalar>> {
  const entry: Record<string, Scalar> = { fault: draft.fault };
  if (draft.fault !== "obstacle" && draft.device !== null) entry.device = draft.device;
  if (draft.begins === "step" && draft.at_step !== null) entry.at_step = draft.at_step;
  for (const field of numbersAsked(draft)) {
    const value = draft.numbers[field];
    if (value !== undefined) entry[field] = value;
  }
  const words = wordsOf(draft.fault);
  if (words.includes("property") && draft.property !== null) entry.property = draft.property;
  if (words.includes("value") && draft.value !== null) entry.value = draft.value;
  if (words.includes("error") && draft.error.trim()) entry.error = draft.error.trim();
  return entry;
}

/** A fault that the server tells of, or that was kept, as a form has it; null for what is none. */
export function draftOf(entry: unknown): FaultDraft | null {
  if (typeof entry !== "object" || entry === null) return null;
  const said = entry as Readonly<Record<string, unknown>>;
  const fault = FAULT_WORDS.find((word) => word === said.fault);
  if (!fault) return null;
  const text = (name: string) => (typeof said[name] === "string" ? said[name] : null);
  const fields = Object.keys(table.ranges) as Field[];
  const numbers = fields.flatMap((name) => (typeof said[name] === "number" ? [[name, said[name]] as const] : []));
  const { value } = said;
  const isScalar = typeof value === "string" || typeof value === "number" || typeof value === "boolean";
  return {
    ...freshFault(fault),
    device: text("device"),
    begins: "at_step" in said ? "step" : "odds" in said ? "chance" : said.at_s ? "at" : "now",
    at_step: text("at_step"),
    property: text("property"),
    value: isScalar ? value : null,
    error: text("error") ?? "",
    numbers: { ...USUAL, ...Object.fromEntries(numbers) },
  };
}
