/** The kinds of steps, as the server's records of constructs have them (`make constructs` writes them here). */
import type { StepKind } from "./document/document";
import records from "./constructs.json";

export type Family = "motion" | "machine" | "logic" | "func" | "note";
export type Shape = "pill" | "box" | "diamond" | "header" | "fork" | "root" | "note";

/** One thing that a step is told, a parameter of it. */
export interface FieldRecord {
  readonly name: string;
  readonly type: string;
  /** What kind of value it takes; any, where it does not say. */
  readonly wanted?: string;
  readonly optional?: boolean;
  /** Fixed words; the first is meant where none is given. */
  readonly choices?: readonly string[];
  /** How many of it a step may have, the others under its name with a number from 2. */
  readonly numbered?: number;
  /** Each choice has a sentence of its own. */
  readonly explained?: boolean;
  /** What a new variable is called in a new step. */
  readonly suggested?: string;
  /** The machines that suit; any place of the map, where it does not say. */
  readonly accepts?: string;
}

interface FormRecord {
  /** The field that tells this form from the last one. */
  readonly marked_by?: string;
  readonly fields?: readonly FieldRecord[];
}

interface Look {
  readonly icon: string;
  readonly family: Family;
  readonly shape: Shape;
  /** The key that takes the tool; empty where there is none. */
  readonly key: string;
  /** Rarely drawn: found under "more" instead of in the rail. */
  readonly rare?: boolean;
  /** In the order in which they are read; those of a Parallel are its own to name. */
  readonly branches?: readonly string[];
  /** What stands in the body is done again. */
  readonly loops?: boolean;
  /** Its condition stands beside the chip. */
  readonly tall?: boolean;
  /** A robot does it: by a method that it describes, or as the fleet tells it. */
  readonly drives?: "robot" | "fleet";
  /** The call that it is in a script. */
  readonly method?: string;
  readonly forms: readonly FormRecord[];
}

export interface Kind extends Look {
  readonly kind: string;
}

/** In the order of the rail. */
export const STEP_KINDS = records as unknown as readonly (Kind & { readonly kind: StepKind })[];
const BY_KIND: ReadonlyMap<string, Kind> = new Map(STEP_KINDS.map((each) => [each.kind, each]));

const UNKNOWN: Kind = { kind: "unknown", icon: "comment", family: "func", shape: "box", key: "", forms: [] };

/** Documents come from other versions, too: not every name is a kind that these screens know. */
export function isStepKind(name: string): name is StepKind {
  return BY_KIND.has(name);
}

export function kindOf(name: string): Kind {
  return BY_KIND.get(name) ?? UNKNOWN;
}

/** The fields of a kind, those of all its forms. */
export function fieldsOf(name: string): readonly FieldRecord[] {
  return kindOf(name).forms.flatMap((form) => form.fields ?? []);
}

/** The word for a kind of step in the catalogues. */
export function kindWordKey(name: string): string {
  return `editor.kind.${isStepKind(name) ? name : "unknown"}`;
}

/** Kinds whose body is drawn inside a frame around their head. */
export function isFramed(name: string): boolean {
  return kindOf(name).shape === "header";
}

/** Frames that carry an arrow on their border: what stands in them is done again. */
export function isLoop(name: string): boolean {
  return kindOf(name).loops ?? false;
}

/** The kinds that a robot does. */
export function isDriving(name: string): boolean {
  return kindOf(name).drives !== undefined;
}
