/** Programs: the document, and what the compiler makes of it. */

import type { Point, Scalar, Words } from "./values";

export type StepKind =
  "move" | "pick" | "drop" | "pick_and_drop" | "operate" | "wait" | "if" | "while" | "parallel" | "try" | "call";

/** Where something is; null or absent: still to be entered. */
export type Place = { device: string } | { place: string } | { point: Point } | { param: string };

/** A scalar or an expression; null or absent: still to be entered. */
export type Value =
  | Scalar
  | null
  | { param: string }
  | { property: [string | { param: string }, string] }
  | { op: string; args: Value[] };

/** `[parent, branch, order]`. */
export type StepPlace = [string, string, string];

export interface Step {
  kind: StepKind;
  place?: StepPlace | null;
  pos?: Point;
  params: Record<string, unknown>;
}

export interface FunctionParameter {
  name: string;
  type: string;
  unit: string;
  default?: Value;
}

export interface FunctionDefinition {
  name: string;
  parameters: FunctionParameter[];
  source?: { library: string; version: number };
}

export interface ProgramRole {
  name: string;
  device?: string;
  can?: string[];
}

export interface Zone {
  name: string;
  rule: "keep_out" | "one_at_a_time" | "slow";
  points: Point[];
  speed_m_s?: number | null;
}

export interface ProgramDocument {
  format: number;
  start_pos?: Point;
  steps: Record<string, Step>;
  functions: Record<string, FunctionDefinition>;
  roles: Record<string, ProgramRole>;
  parameters: Record<string, FunctionParameter>;
  zones: Record<string, Zone>;
}

export interface DiagnosticFix {
  label: string;
  labels: Words;
  label_code: string;
  step: string;
  field: string;
  value: unknown;
}

export interface Diagnostic {
  code: string;
  severity: "error" | "warning";
  step: string;
  field: string;
  message: string;
  messages: Words;
  when: "now" | "ever";
  args: Record<string, unknown>;
  line: number | null;
  fix: DiagnosticFix | null;
}

export interface Compiled {
  revision: number;
  script: string;
  /** Step id, or "", for each line of the script. */
  lines: string[];
  numbers: Record<string, string>;
  diagnostics: Diagnostic[];
  added_moves: string[];
  order: string[];
  depth: Record<string, number>;
}

export interface Program {
  id: string;
  name: string;
  site: string;
  kinds: StepKind[];
  /** The ids of the devices that it names. */
  devices: string[];
  edited_at: string;
  edited_by: { name: string; initials: string } | string | null;
  errors: number;
  warnings: number;
}

export interface LibraryFunction {
  id: string;
  name: string;
  description: string;
  version: number;
  author: { name: string; initials: string } | string | null;
  parameters: FunctionParameter[];
  used_in: number;
  updated_at: string;
  script?: string;
  definition?: { function: FunctionDefinition; steps: Record<string, Step> };
}
