/** The document (format 1) as plain JSON; docs/architecture.md, "The document". */

export type StepKind =
  "move" | "pick" | "drop" | "pick_and_drop" | "operate" | "wait" | "if" | "while" | "parallel" | "try" | "call";

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
  | { readonly param: string }
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
  readonly source?: { readonly library: string; readonly version: number } | null;
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
  readonly parameters: Readonly<Record<string, unknown>>;
  readonly zones: Readonly<Record<string, unknown>>;
}

export interface Fix {
  readonly label: string;
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
  format: 1,
  start_pos: null,
  steps: {},
  functions: {},
  roles: {},
  parameters: {},
  zones: {},
};
