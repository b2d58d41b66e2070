/** Steps cut out of a program, as data that also fits the clipboard, and put into the same or another one. */
import type { Edit, StepPlace } from "./edits";
import {
  type Position,
  type FunctionDefinition,
  type ProgramDocument,
  type Role,
  type Step,
  type Zone,
} from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { endOfBranch, roomAt, type Goal, type MakeId } from "./joints";
import { DEFAULT_ROLE, givenToRole, roleOfStep } from "@/program/operation";
import { bodiesOf, calledBy, standingAlone } from "@/program/document/called";
import { EVENTS, readTree, withDescendants, type ProgramTree } from "@/program/document/tree";
import { type IdKey, paramsWithIds, withIds } from "./substitution";
import { idsNamedBy } from "./uses";

/** Steps with all inside them, the functions they call with their bodies, and the roles and zones that they name. */
export interface Clipping {
  /** The program that they were cut out of, where that is known. */
  readonly program?: string;
  readonly steps: Readonly<Record<string, Step>>;
  /** Those that stand in no other one and in no function that comes along, in their order. */
  readonly outer: readonly string[];
  readonly functions: Readonly<Record<string, FunctionDefinition>>;
  readonly bodies: Readonly<Record<string, Step>>;
  readonly roles: Readonly<Record<string, Role>>;
  readonly zones: Readonly<Record<string, Zone>>;
}

const MARK = "vipo steps 2";

export function clip(document: ProgramDocument, ids: readonly string[], program?: string): Clipping {
  const outer = sortByReading(readTree(document), standingAlone(document, ids));
  const steps = pickSteps(document, withDescendants(document, outer));
  const functions = calledBy(document, outer);
  const bodies = pickSteps(document, bodiesOf(document, functions));
  const all = [...Object.values(steps), ...Object.values(bodies)];
  const definitions = Object.entries(document.functions).filter(([id]) => functions.has(id));
  return {
    ...(program === undefined ? {} : { program }),
    steps,
    outer,
    functions: Object.fromEntries(definitions),
    bodies,
    roles: namedOf(document.roles, all, "role"),
    zones: namedOf(document.zones, all, "zone"),
  };
}

function namedOf<T>(
  known: Readonly<Record<string, T>>,
  steps: readonly Step[],
  key: "role" | "zone",
): Record<string, T> {
  const named = new Set(steps.flatMap((step) => [...idsNamedBy(step, key)]));
  return Object.fromEntries(Object.entries(known).filter(([id]) => named.has(id)));
}

export function clippingToText(clipping: Clipping): string {
  return JSON.stringify({ type: MARK, ...clipping });
}

/** What `clippingToText` gave; null for any other text. */
export function clippingFromText(text: string): Clipping | null {
  if (!text.includes(MARK)) return null;
  try {
    const {
      type,
      zones = {},
      ...rest
    } = JSON.parse(text) as { type?: string } & Omit<Clipping, "zones"> & {
        /** Missing in what was copied before clippings had them. */
        zones?: Clipping["zones"];
      };
    const { program, steps, outer, functions, bodies, roles } = rest;
    const whole = [steps, functions, bodies, roles, zones].every((part) => typeof part === "object" && part);
    const sound = type === MARK && whole && Array.isArray(outer) && outer.every((id: string) => isStep(steps[id]));
    const all = sound && [...Object.values(steps), ...Object.values(bodies)].every(isStep);
    return all ? { ...(program ? { program } : {}), steps, outer, functions, bodies, roles, zones } : null;
  } catch {
    return null;
  }
}

function isStep(value: unknown): boolean {
  const step = value as Step | null | undefined;
  return typeof step?.kind === "string" && typeof step.params === "object" && step.params !== null;
}

function pickSteps(document: ProgramDocument, ids: Iterable<string>): Record<string, Step> {
  return Object.fromEntries(
    [...ids].flatMap((id) => {
      const step = document.steps[id];
      return step ? [[id, step] as const] : [];
    }),
  );
}

export function sortByReading(tree: ProgramTree, ids: readonly string[]): string[] {
  const order = new Map([...tree.reading, ...tree.loose].map((id, index) => [id, index]));
  return [...ids].sort((one, other) => (order.get(one) ?? 0) - (order.get(other) ?? 0));
}

/** How far copies stand from their originals, in metres. */
const BESIDE: Position = [0.5, -0.5];

/**
 * Put copies with ids of their own at a goal of a program, a little beside the originals. What their own program calls
 * by an id is what it has under it now; in another one what has that id and is something else stays as it is.
 */
export function paste(
  document: ProgramDocument,
  clipping: Clipping,
  goal: Goal,
  makeId: MakeId,
  here = clipping.program,
): { edits: Edit[]; added: string[] } {
  const fresh = new Map(Object.keys(clipping.steps).map((id) => [id, makeId()]));
  const own = here === clipping.program;
  const functions = functionsOf(document, clipping, own, makeId);
  const bodies = bodiesWith(clipping, functions.fresh);
  const brought = [...Object.values(clipping.steps), ...Object.values(bodies)];
  const { edits: named, others: rest } = companyOf(document, clipping, brought, own, makeId);
  const others = { ...rest, function: functions.others };
  const copies = Object.entries(clipping.steps).map(([id, step]): Edit => {
    const inner = clipping.outer.includes(id) ? null : placeInCopy(step, fresh);
    const copy = withOthers({ ...step, place: inner }, others);
    return { do: "add_step", id: fresh.get(id) ?? id, step: moved(copy, BESIDE) };
  });
  const among = (id: string) => fresh.get(id) ?? id;
  const places = [
    ...placesFor(document, clipping, goal, among, (kind) => kind !== "comment" && kind !== "on_event"),
    ...placesFor(document, clipping, endOfBranch(document, EVENTS), among, (kind) => kind === "on_event"),
  ];
  const edits = [...named, ...functionEdits(functions.fresh, bodies, others, makeId), ...copies];
  return { edits: [...edits, ...places], added: clipping.outer.map((id) => fresh.get(id) ?? id) };
}

function placeInCopy(step: Step, fresh: ReadonlyMap<string, string>): StepPlace | null {
  const parent = fresh.get(step.place?.[0] ?? "");
  return step.place && parent !== undefined ? [parent, step.place[1], step.place[2]] : null;
}

function placesFor(
  document: ProgramDocument,
  clipping: Clipping,
  goal: Goal,
  copyOf: (id: string) => string,
  fits: (kind: string) => boolean,
): readonly Edit[] {
  const ids = clipping.outer.filter((id) => fits(clipping.steps[id]?.kind ?? "comment"));
  const room = roomAt(document, goal, ids.length);
  return [
    ...room.shifted,
    ...ids.map((id, index): Edit => ({ do: "set_place", id: copyOf(id), place: room.places[index] ?? null })),
  ];
}

/** What steps name and the program lacks, and other ids for what it has under the same ids for something else. */
interface Company {
  readonly edits: readonly Edit[];
  readonly others: Omit<Others, "function">;
}
type Others = Readonly<Record<IdKey, ReadonlyMap<string, string>>>;

function companyOf(
  document: ProgramDocument,
  clipping: Clipping,
  brought: readonly Step[],
  own: boolean,
  makeId: MakeId,
): Company {
  const roles = meeting<Role>(namedOf(clipping.roles, brought, "role"), document.roles, makeId, {
    // Every program has the usual role, though it says nothing of it: there it is that of the steps that have it.
    stays: (id) => own && (id in document.roles || (id === DEFAULT_ROLE && isNamed(document, id, "role"))),
    isTaken: (id) => id in document.roles || (!own && isNamed(document, id, "role")),
    // Of one robot, or of robots that can do and must meet the same.
    isAlike: ([one, there], [id, role]) =>
      role.device ? there.device === role.device : isSameValue(there, roleAs(role, id, one)),
  });
  const zones = meeting<Zone>(namedOf(clipping.zones, brought, "zone"), document.zones, makeId, {
    stays: (id) => own && id in document.zones,
    isTaken: (id) => id in document.zones || (!own && isNamed(document, id, "zone")),
    isAlike: ([, there], [, zone]) => isSameValue(there, zone),
  });
  return {
    edits: [
      ...roles.fresh.map(([id, other, role]): Edit => ({ do: "set_role", id: other, value: roleAs(role, id, other) })),
      ...zones.fresh.map(([, other, zone]): Edit => ({ do: "set_zone", id: other, value: zone })),
    ],
    others: { role: roles.others, zone: zones.others },
  };
}

type Named<T> = readonly [id: string, value: T];
interface Rules<T> {
  /** What is there under the id is meant, whatever it is now. */
  readonly stays: (id: string) => boolean;
  /** What comes in cannot have the id, unless what is there is alike. */
  readonly isTaken: (id: string) => boolean;
  readonly isAlike: (there: Named<T>, wanted: Named<T>) => boolean;
}

interface Meeting<T> {
  readonly fresh: readonly (readonly [id: string, other: string, value: T])[];
  readonly others: ReadonlyMap<string, string>;
}

/** What comes in, each with its id before and now, and the ids by which the steps have to name what they named. */
function meeting<T>(
  wanted: Readonly<Record<string, T>>,
  there: Readonly<Record<string, T>>,
  makeId: MakeId,
  { stays, isTaken, isAlike }: Rules<T>,
): Meeting<T> {
  const fresh: [string, string, T][] = [];
  const others = new Map<string, string>();
  for (const [id, value] of Object.entries(wanted)) {
    if (stays(id)) continue;
    const alike = isTaken(id) ? alikeTo([id, value], there, isAlike) : undefined;
    const other = alike ?? (isTaken(id) ? makeId() : id);
    if (other !== id) others.set(id, other);
    if (alike === undefined) fresh.push([id, other, value]);
  }
  return { fresh, others };
}

/** The id of what is there and alike: the same id, if that is. */
function alikeTo<T>(
  wanted: Named<T>,
  there: Readonly<Record<string, T>>,
  isAlike: Rules<T>["isAlike"],
): string | undefined {
  const alike = Object.entries(there).flatMap((each) => (isAlike(each, wanted) ? [each[0]] : []));
  return alike.find((id) => id === wanted[0]) ?? alike[0];
}

/** The role under another id, which its own condition names, too. */
function roleAs(role: Role, id: string, other: string): Role {
  if (other === id) return role;
  return withIds({ ...role, name: role.name ?? id }, (each) => (each === id ? other : each)) as Role;
}

function isNamed(document: ProgramDocument, id: string, key: "role" | "zone"): boolean {
  return Object.values(document.steps).some((step) => idsNamedBy(step, key).has(id));
}

function withOthers(step: Step, others: Others): Step {
  const params = paramsWithIds(step.params, (id, key) => others[key].get(id) ?? id);
  const role = others.role.get(roleOfStep(step) ?? "");
  if (role === undefined) return { ...step, params };
  const { name, value } = givenToRole(step, role);
  return { ...step, params: { ...params, [name]: value } };
}

/** Functions meet as roles and zones do; those are alike whose steps say the same. */
function functionsOf(document: ProgramDocument, clipping: Clipping, own: boolean, makeId: MakeId) {
  const isTaken = (id: string) => id in document.functions;
  const there = { ...clipping, steps: clipping.bodies };
  return meeting(clipping.functions, document.functions, makeId, {
    stays: (id) => own && isTaken(id),
    isTaken,
    isAlike: ([one, known], [id, value]) =>
      isSameValue(known, value) && isSameValue(saidBy(document, one), saidBy(there, id)),
  });
}

/** What a function says, with what they mean in place of the ids that its steps name; each function in it once. */
function saidBy(
  parts: Pick<ProgramDocument, "functions" | "roles" | "steps" | "zones">,
  id: string,
  said: string[] = [],
): unknown {
  said.push(id);
  // Only compared: what stands in an id's place need be no text.
  const meant = (each: string, key: IdKey) => meaning(each, key) as string;
  const meaning = (each: string, key: IdKey) => {
    if (key === "zone") return parts.zones[each];
    if (key === "function") return said.includes(each) ? said.indexOf(each) : saidBy(parts, each, said);
    const role = parts.roles[each];
    return role?.device ?? (role && roleAs(role, each, ""));
  };
  const within = (parent: string): unknown[] =>
    Object.entries(parts.steps)
      .flatMap(([each, step]) => (step.place?.[0] === parent ? [[each, step, step.place.join()] as const] : []))
      .sort(([, , one], [, , other]) => (one < other ? -1 : 1))
      .map(([each, step]) => {
        const params = paramsWithIds({ ...step.params, role: roleOfStep(step) ?? "" }, meant);
        return [step.kind, step.place?.[1], params, within(each)];
      });
  return [parts.functions[id], within(id)];
}

type Fresh = Meeting<FunctionDefinition>["fresh"];

/** The steps in the functions that come in. */
function bodiesWith({ bodies }: Clipping, functions: Fresh): Clipping["bodies"] {
  const ids = functions.map(([id]) => id);
  return Object.fromEntries(Object.entries(bodies).filter(([, step]) => ids.includes(topOf(bodies, step))));
}

function functionEdits(functions: Fresh, bodies: Clipping["bodies"], others: Others, makeId: MakeId): Edit[] {
  const fresh = new Map<string, string>(functions.map(([id, other]) => [id, other]));
  for (const id of Object.keys(bodies)) fresh.set(id, makeId());
  return [
    ...functions.map(([, id, value]): Edit => ({ do: "set_function", id, value })),
    ...Object.entries(bodies).map(([id, step]): Edit => {
      const copy = withOthers({ ...step, place: placeInCopy(step, fresh) }, others);
      return { do: "add_step", id: fresh.get(id) ?? id, step: copy };
    }),
  ];
}

/** The function that a step of a body stands in. */
function topOf(bodies: Clipping["bodies"], step: Step): string {
  let above = step.place?.[0] ?? "";
  for (const seen = new Set<string>(); above in bodies && !seen.has(above);) {
    seen.add(above);
    above = bodies[above]?.place?.[0] ?? "";
  }
  return above;
}

export function moved(step: Step, [dx, dy]: Position): Step {
  const [x, y] = step.pos ?? [0, 0];
  return { ...step, pos: [toCentimetre(x + dx), toCentimetre(y + dy)] };
}

export function toCentimetre(value: number): number {
  return Math.round(value * 100) / 100 + 0;
}
