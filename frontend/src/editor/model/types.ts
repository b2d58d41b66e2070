/** The document (format 2) as plain JSON; docs/adr/0005-the-whole-language.md. */

export type StepKind =
  | "move"
  | "pick"
  | "drop"
  | "pick_and_drop"
  | "operate"
  | "wait"
  | "if"
  | "while"
  | "repeat"
  | "for_each"
  | "parallel"
  | "try"
  | "call"
  | "set"
  | "ask"
  | "notify"
  | "end"
  | "return"
  | "break"
  | "on_event"
  | "comment";

export type Place =
  | { readonly device: string }
  | { readonly place: string }
  | { readonly point: readonly [number, number] }
  | { readonly param: string };

export type Value =
  | string
  | number
  | boolean
  | null
  | readonly Value[]
  | { readonly param: string }
  | { readonly quantity: readonly [number, string] }
  | { readonly at: Place | { readonly role: string } }
  | { readonly zone: string }
  | { readonly property: readonly [string | { readonly param: string }, string] }
  | { readonly op: string; readonly args: readonly Value[] };

export interface Step {
  readonly kind: string;
  readonly place?: readonly [string, string, string] | null;
  readonly pos?: readonly [number, number] | null;
  readonly params: Readonly<Record<string, unknown>>;
}

export interface Parameter {
  readonly name: string;
  readonly type: string;
  readonly unit?: string | null;
  readonly default?: unknown;
}

export interface FunctionDefinition {
  readonly name: string;
  readonly parameters: readonly Parameter[];
  readonly result?: { readonly type: string; readonly unit?: string | null } | null;
  readonly source?: { readonly library: string; readonly version: number } | null;
}

/** How a person may answer. */
export interface Answer {
  readonly type: "boolean" | "number" | "text" | "choice";
  readonly unit?: string | null;
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  readonly options?: readonly string[] | null;
}

/** A named area with a rule; no step. */
export interface Zone {
  readonly name: string;
  readonly rule: "keep_out" | "one_at_a_time" | "slow";
  /** At least three corners, metres. */
  readonly points: readonly (readonly [number, number])[];
  readonly speed_m_s?: number | null;
}

export interface Role {
  readonly name?: string;
  readonly device?: string;
  readonly can?: readonly string[];
}

export interface ProgramDocument {
  readonly format: number;
  readonly start_pos?: readonly [number, number] | null;
  readonly steps: Readonly<Record<string, Step>>;
  readonly functions: Readonly<Record<string, FunctionDefinition>>;
  readonly roles: Readonly<Record<string, Role>>;
  readonly parameters: Readonly<Record<string, Parameter>>;
  readonly zones: Readonly<Record<string, Zone>>;
}

/** A sentence in each language of the screens. */
export interface Words {
  readonly en: string;
  readonly de: string;
}

export interface Fix {
  readonly label: string;
  readonly labels?: Words;
  readonly label_code?: string;
  readonly step: string;
  readonly field: string;
  readonly value: unknown;
}

export interface Diagnostic {
  readonly code: string;
  readonly severity: "error" | "warning";
  readonly step: string;
  readonly field: string;
  readonly message: string;
  readonly messages?: Words;
  /** `now`: so only as the site is at present; `ever`: until the program changes. */
  readonly when?: "now" | "ever";
  readonly line?: number | null;
  readonly fix?: Fix | null;
}

/** What the server says about the document as it is. */
export interface Compiled {
  readonly revision?: number | string;
  readonly script: string;
  readonly lines: readonly string[];
  readonly numbers: Readonly<Record<string, string>>;
  readonly diagnostics: readonly Diagnostic[];
  readonly added_moves: readonly string[];
  readonly order: readonly string[];
  readonly depth: Readonly<Record<string, number>>;
}

export const EMPTY_DOCUMENT: ProgramDocument = {
  format: 2,
  start_pos: null,
  steps: {},
  functions: {},
  roles: {},
  parameters: {},
  zones: {},
};
