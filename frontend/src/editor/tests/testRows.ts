/** The lines of a test's form: what is filled in, what of it can be written already, and what the text says of it; pure. */
import { draftOf, entryOf, type FaultDraft, type FaultSurroundings, problemsOf } from "@/shell/start/faults";
import type { Entry, Given, GivenKind, Scalar, TestValues } from "./testText";

/** What is expected, as a form offers it; `other` is what only the text can say. */
export const THEN = ["ends", "within_s", "item", "step", "commands", "property", "zone", "near", "fails"] as const;
export type ThenKind = (typeof THEN)[number] | "other";
export const COMPARISONS = ["at_least", "at_most", "is"] as const;

export interface GivenRow {
  readonly key: string;
  readonly kind: GivenKind;
  readonly device: string | null;
  readonly name: string | null;
  readonly value: Scalar | null;
}

export interface ThenRow {
  readonly key: string;
  readonly kind: ThenKind;
  readonly says: Readonly<Record<string, Scalar | readonly string[] | null>>;
  /** What stands in the text, until somebody changes it here. */
  readonly written: Entry | null;
}

export interface FaultRow {
  readonly draft: FaultDraft | null;
  /** Somebody has filled something in, so what is missing is told. */
  readonly isTouched: boolean;
  readonly written: Entry | null;
}

export interface TestRows {
  readonly given: readonly GivenRow[];
  readonly faults: readonly FaultRow[];
  readonly then: readonly ThenRow[];
}

/** A step's id for its number, and for its id. */
export type StepNamed = (said: string) => string | null;

const key = () => crypto.randomUUID();
export const freshGiven = (kind: GivenKind): GivenRow => ({ key: key(), kind, device: null, name: null, value: null });
export const freshThen = (kind: ThenKind): ThenRow => ({ key: key(), kind, says: USUAL[kind] ?? {}, written: null });

const USUAL: Partial<Record<ThenKind, ThenRow["says"]>> = {
  within_s: { value: 600 },
  item: { count: 1 },
  property: { compared: "at_least" },
  near: { within_m: 1 },
  commands: { value: [] },
};

export function rowsOf(values: TestValues, stepNamed: StepNamed): TestRows {
  return {
    given: values.given.map((line) => ({ key: key(), ...line })),
    faults: values.faults.map((written) => ({ draft: faultDraft(written, stepNamed), isTouched: false, written })),
    then: values.then.map((written) => thenRow(written, stepNamed)),
  };
}

function faultDraft(written: Entry, stepNamed: StepNamed): FaultDraft | null {
  const { at_step } = written;
  const named = typeof at_step === "string" || typeof at_step === "number" ? stepNamed(String(at_step)) : null;
  return draftOf(named === null ? written : { ...written, at_step: named });
}

function thenRow(written: Entry, stepNamed: StepNamed): ThenRow {
  const [kind, says] = whatIs(written);
  const named = kind === "step" && typeof says.step === "string" ? stepNamed(says.step) : null;
  return { key: key(), kind, says: named === null ? says : { ...says, step: named }, written };
}

const OTHER = ["other", {}] as const;
type Says = ThenRow["says"];

function whatIs(written: Entry): readonly [ThenKind, Says] {
  const [[kind, value] = ["", null], ...more] = Object.entries(written);
  if (more.length > 0) return OTHER;
  if (kind === "ends") return value === "well" ? ["ends", {}] : OTHER;
  if (kind === "fails") return typeof value === "string" ? ["fails", { value }] : OTHER;
  if (kind === "within_s") return typeof value === "number" ? ["within_s", { value }] : OTHER;
  if (kind === "commands") return commandsOf(value);
  if (typeof value !== "object" || value === null || Array.isArray(value)) return OTHER;
  const says = value as Says;
  if (kind === "item") return ["item", says];
  if (kind === "step") return ["step", { ...says, step: says.step === undefined ? null : String(says.step) }];
  if (kind === "never_two_in") return ["zone" in says ? "zone" : "near", says];
  return kind === "property" ? propertyOf(says) : OTHER;
}

function commandsOf(value: unknown): readonly [ThenKind, Says] {
  const listed: readonly unknown[] = Array.isArray(value) ? value : [value];
  const texts = listed.filter((each) => typeof each === "string");
  return texts.length === listed.length ? ["commands", { value: texts }] : OTHER;
}

function propertyOf({ device = null, name = null, ...rest }: Says): readonly [ThenKind, Says] {
  const compared = COMPARISONS.find((word) => word in rest);
  return compared ? ["property", { device, name, compared, value: rest[compared] ?? null }] : OTHER;
}

/** The line as the text has it; null while something is missing. */
export function thenEntry({ kind, says, written }: ThenRow): Entry | null {
  if (written) return written;
  const has = (...names: string[]) =>
    names.every((name) => says[name] !== undefined && says[name] !== null && says[name] !== "");
  const some = (...names: string[]) =>
    Object.fromEntries(names.filter((name) => has(name)).map((name) => [name, says[name]]));
  switch (kind) {
    case "ends":
      return { ends: "well" };
    case "fails":
    case "within_s":
      return has("value") ? { [kind]: says.value } : null;
    case "commands":
      return Array.isArray(says.value) && says.value.length > 0 ? { commands: says.value } : null;
    case "item":
      return has("object", "at") ? { item: some("object", "at", "count") } : null;
    case "step":
      return has("step") ? { step: some("step", "times") } : null;
    case "zone":
      return has("zone") ? { never_two_in: some("zone") } : null;
    case "near":
      return has("place") ? { never_two_in: some("place", "within_m") } : null;
    case "property":
      return has("device", "name", "value")
        ? { property: { ...some("device", "name"), [String(says.compared)]: says.value } }
        : null;
    case "other":
      return null;
  }
}

/** What can be written of these lines; lines that lack something are not among it. */
export function valuesOf(rows: TestRows, around: FaultSurroundings): Pick<TestValues, "given" | "faults" | "then"> {
  return {
    given: rows.given.flatMap(({ kind, device, name, value }): Given[] =>
      device && name && value !== null ? [{ kind, device, name, value }] : [],
    ),
    faults: rows.faults.flatMap(({ draft, written }) => {
      if (written) return [written];
      return draft && Object.keys(problemsOf(draft, around)).length === 0 ? [entryOf(draft)] : [];
    }),
    then: rows.then.flatMap((row): Entry[] => {
      const entry = thenEntry(row);
      return entry ? [entry] : [];
    }),
  };
}

/** Whether a line has all that it needs, and so stands in the text. */
export const isWhole = {
  given: ({ device, name, value }: GivenRow) => device !== null && name !== null && value !== null,
  then: (row: ThenRow) => thenEntry(row) !== null,
};
