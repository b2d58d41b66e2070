/** The shapes that cross the border to the server, as docs/architecture.md names them. */

export type Point = [number, number];
export type Role = "viewer" | "operator" | "author" | "admin";

export interface User {
  id: number;
  name: string;
  initials: string;
  email: string;
}

export interface DemoAccount {
  email: string;
  password: string;
  role: Role;
}

export interface Me {
  user: User | null;
  csrf: string;
  demo_accounts: DemoAccount[];
}

export interface SiteStop {
  active: boolean;
  by: string | null;
  /** ISO 8601. */
  at: string | null;
}

export interface Site {
  slug: string;
  name: string;
  role: Role;
  machines: number;
  robots: number;
  online: number;
  pending: number;
  has_map: boolean;
  stop: SiteStop;
  simulated: boolean;
}

export interface MapPlace {
  id: string;
  name: string;
  kind: string;
  x: number;
  y: number;
  theta: number;
}

export interface SiteMapInfo {
  version: number;
  width: number;
  height: number;
  resolution_m: number;
  origin: { x: number; y: number; yaw: number };
  places: MapPlace[];
  walls: [number, number, number, number][];
}

/** A map with its cells: row by row from the bottom row, 0 free, 100 wall, 255 unknown. */
export interface SiteMap extends SiteMapInfo {
  cells: Uint8Array;
}

export type DeviceStatus = "idle" | "busy" | "done" | "waiting" | "warning" | "error" | "offline" | "pending";
export type Lifecycle = "pending" | "approved" | "retired";
export type Scalar = string | number | boolean;

export interface DeviceProperty {
  name: string;
  type: string;
  unit: string;
  minimum: number | null;
  maximum: number | null;
  value: Scalar | null;
}

export interface MethodParameter {
  name: string;
  type: string;
  unit: string;
  minimum: number | null;
  maximum: number | null;
  options: Scalar[] | null;
  required: boolean;
}

export interface DeviceMethod {
  name: string;
  title: string;
  topic: string;
  message_type: string;
  parameters: MethodParameter[];
}

export interface Device {
  id: string;
  name: string;
  kind: "robot" | "machine";
  device_class: string;
  icon: string;
  lifecycle: Lifecycle;
  status: DeviceStatus;
  doing: string;
  location: { x: number; y: number; z: number; theta: number };
  size: { x: number; y: number; z: number };
  radius_m: number | null;
  properties: DeviceProperty[];
  methods: DeviceMethod[];
  gives: string[];
  takes: string[];
  capacity: number;
  carrying: Record<string, number>;
  last_seen_at: string | null;
  done: boolean;
  simulated: boolean;
  image: string;
  description: string;
  has_key: boolean;
  dropped: number;
}

/** Something that a person told a device to do; `over` once nothing more will come of it. */
export interface MethodCall {
  id: string;
  device: string;
  method: string;
  args: Record<string, unknown>;
  by: string;
  status: "pending" | "sent" | "accepted" | "running" | "done" | "failed" | "rejected" | "cancelled" | "timed_out";
  over: boolean;
  why: string;
  result: Record<string, Scalar | null>;
  created_at: string;
  expires_at: string;
  sent_at: string | null;
  ended_at: string | null;
}

/** What a property was; `points` oldest first, the first may lie before `since`. */
export interface Series {
  property: string;
  unit: string;
  since: string;
  bucket_s: number;
  points: { at: string; minimum: number | null; maximum: number | null; value: Scalar | null }[];
}

/** A field of a description that changed; its JSON, empty where it was or is not there. */
export interface FieldChange {
  path: string;
  before: string;
  after: string;
}

export interface DeviceEvent {
  at: string;
  kind: string;
  text: string;
  by: string | null;
  changes: FieldChange[];
}

/* The program document, format 1. */

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

/** A sentence in each language of the screens. */
export interface Words {
  en: string;
  de: string;
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

export type RehearsalStatus = "queued" | "running" | "done" | "failed";

export interface Rehearsal {
  id: string;
  status: RehearsalStatus;
  /** 0 to 1. */
  progress: number;
  result: RehearsalResult | null;
  document: ProgramDocument;
  compiled: Compiled;
}

export interface NearMiss {
  t: number;
  a: string;
  b: string;
  distance_m: number;
  x: number;
  y: number;
}

/** A line of a rehearsal's log; older ones have no code. */
export interface LogLine {
  t: number;
  step: string;
  device: string;
  text: string;
  code?: string;
  args?: Record<string, Scalar>;
}

export interface RehearsalError {
  t: number;
  step: string;
  kind: string;
  message: string;
  code?: string;
  args?: Record<string, Scalar>;
}

export interface RehearsalResult {
  ok: boolean;
  duration_s: number;
  errors: RehearsalError[];
  robots: Record<string, { distance_m: number; busy_s: number; wait_s: number; battery: number }>;
  machines: Record<string, { busy_s: number }>;
  near_misses: NearMiss[];
  collisions: NearMiss[];
  waits: { t: number; duration_s: number; robot: string; reason: string; why?: WaitReason }[];
  steps: {
    step: string;
    count: number;
    robot: string | null;
    device: string | null;
    started_s: number;
    ended_s: number | null;
    status: StepStatus;
  }[];
  frames: { dt_s: number; robots: Record<string, [number, number, number][]> };
  carrying: Record<string, [number, Record<string, number>][]>;
  machine_states: Record<string, [number, boolean][]>;
  properties: Record<string, [number, string, Scalar][]>;
  routes: { t: number; robot: string; path: Point[] }[];
  log: LogLine[];
}

export type RunStatus = "pending" | "running" | "paused" | "finished" | "failed" | "cancelled";
export type StepStatus = "waiting" | "running" | "done" | "failed" | "skipped";

export interface RunStep {
  status: StepStatus;
  started_at: string | null;
  ended_at: string | null;
  robot: string | null;
  wait: string | null;
  why?: WaitReason | null;
  count: number;
}

/** Why something waits; devices are named by their ids. */
export interface WaitReason {
  code: string;
  args: Record<string, Scalar>;
}

export interface AnswerSpec {
  type: "boolean" | "number" | "text" | "choice";
  unit: string;
  minimum: number | null;
  maximum: number | null;
  options: string[];
}

/** Something that a run asks the people of its site. */
export interface Question {
  id: string;
  run: string;
  run_number: number;
  program: { id: string; name: string };
  site: string;
  step: string;
  text: string;
  answer: AnswerSpec;
  state: "open" | "answered" | "withdrawn";
  value: Scalar | null;
  asked_at: string;
  answered_by: string;
  answered_at: string | null;
}

/** A program that starts by itself. */
export interface ArmedProgram {
  program: string;
  version: number;
  by: string;
  at: string;
}

/** A run as lists and live messages have it. */
export interface RunSummary {
  id: string;
  number: number;
  program: { id: string; name: string };
  version: number | null;
  site: string;
  status: RunStatus;
  reason: string;
  started_at: string | null;
  ended_at: string | null;
  started_by: { name: string; initials: string } | string | null;
  steps: Record<string, RunStep>;
  roles: Record<string, string>;
}

export interface Run extends RunSummary {
  document: ProgramDocument;
  compiled: Compiled;
}

export interface RunEvent {
  seq: number;
  at: string;
  t_s: number;
  kind: string;
  step: string;
  device: string;
  robot: string;
  text: string;
  code: string;
  args: Record<string, unknown>;
}

export interface RouteAnswer {
  path: Point[];
  length_m: number;
  seconds: number;
}

export interface RobotTraffic {
  route: Point[];
  reserved: Point[];
  wait: string | null;
  why?: WaitReason | null;
}
