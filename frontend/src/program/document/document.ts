/** The document (format 2) and what the server says about it, as the screens read them: nothing in them is changed. */
import type { components } from "@/api/schema";

type Schemas = components["schemas"];
type Frozen<T> = T extends (infer Item)[]
  ? number extends T["length"]
    ? readonly Frozen<Item>[]
    : { readonly [Index in keyof T]: Frozen<T[Index]> }
  : T extends object
    ? { readonly [Key in keyof T]: Frozen<T[Key]> }
    : T;

/** Metres. */
export type Position = readonly [x: number, y: number];
export type StepKind = Schemas["StepKind"];
export type Place = Frozen<Schemas["Place"]>;
export type Value =
  | Frozen<Exclude<Schemas["Value"], unknown[] | Schemas["Operation"]>>
  | { readonly op: string; readonly args: readonly Value[] }
  | readonly Value[];
/** As people and merges have left it: its kind may be one that this version of the screens does not know. */
export type Step = Frozen<Omit<Schemas["StepShape"], "kind"> & { kind: string }>;
export type Parameter = Frozen<Schemas["ParameterDefinition"]>;
export type FunctionDefinition = Frozen<Schemas["FunctionShape"]>;
type AnswerShape = Frozen<Schemas["AnswerShape"]>;
/** How a person may answer, as far as the step says it. */
export type Answer = Pick<AnswerShape, "type"> & { readonly [Key in keyof AnswerShape]?: AnswerShape[Key] | null };
/** A named area with a rule; no step. */
export type Zone = Frozen<Schemas["ZoneShape"]>;
export type Role = Frozen<Schemas["RoleShape"]>;
export type ProgramDocument = Frozen<
  Omit<Schemas["DocumentShape"], "format" | "steps"> & { format: number; steps: Record<string, Step> }
>;
/** A sentence in each language of the screens. */
export type Words = Frozen<Schemas["Words"]>;
export type Fix = Frozen<Schemas["FixShape"]>;
export type Diagnostic = Frozen<Schemas["DiagnosticShape"]>;
export type Compiled = Frozen<Schemas["CompiledShape"]>;

export const EMPTY_DOCUMENT: ProgramDocument = {
  format: 2,
  start_pos: null,
  steps: {},
  functions: {},
  roles: {},
  parameters: {},
  zones: {},
};

/** A value as text; `otherwise` where it is none, whatever other people may have written. */
export function textOf(value: unknown, otherwise = ""): string {
  return typeof value === "string" || typeof value === "number" ? String(value) : otherwise;
}
