/** Functions made of steps, and calls turned back into the steps of their function. */
import { ownEntry } from "@/design/ownEntry";
import { moved, toCentimetre } from "./clipping";
import type { Decision, Edit, Refusal } from "./edits";
import { type Parameter, type Position, type ProgramDocument, type Step, textOf } from "@/program/document/document";
import { branchOf, neighbours, roomAt, type MakeId } from "./joints";
import { namesBeside, namesOfLoops, namesSetIn, numbered, ownNames } from "./scopes";
import { paramsWith } from "./substitution";
import { ancestors, EVENTS, readTree, withDescendants } from "@/program/document/tree";

/** Make a function of the steps and call it where they stood; they must be neighbours in one branch. */
export function wrapInFunction(
  document: ProgramDocument,
  ids: readonly string[],
  fresh: { functionId: string; callId: string; name: string },
): Decision {
  const found = neighbours(document, ids);
  if (!found) return { refused: ids.length > 0 ? "one_branch" : "nothing" };
  if (found.goal.branch.branch === EVENTS.branch) return { refused: "event" };
  const { steps } = found;
  const call: Step = {
    kind: "call",
    place: document.steps[steps[0] ?? ""]?.place,
    pos: underAll(document, steps),
    params: { function: fresh.functionId, args: {} },
  };
  const room = roomAt(document, { branch: { parent: fresh.functionId, branch: "body" }, after: null }, steps.length);
  return {
    edits: [
      { do: "set_function", id: fresh.functionId, value: { name: fresh.name, parameters: [] } },
      ...steps.map((id, index): Edit => ({ do: "set_place", id, place: room.places[index] ?? null })),
      { do: "add_step", id: fresh.callId, step: call },
    ],
  };
}

/** Under the lowest of the steps: a fresh call covers none of its own. */
function underAll(document: ProgramDocument, ids: readonly string[]): Position {
  const positions = ids.map((id) => document.steps[id]?.pos ?? [0, 0]);
  const across = positions.reduce((sum, [x]) => sum + x, 0) / Math.max(1, positions.length);
  return below([across, Math.min(...positions.map(([, y]) => y))], 1);
}

/** So many chips below. */
function below(pos: Position | null | undefined, count: number): Position {
  const [x, y] = pos ?? [0, 0];
  return [toCentimetre(x), toCentimetre(y - 0.9 * count)];
}

/** The steps of a function: those that stand in no other one in their order, and all. */
interface Body {
  readonly functionId: string;
  readonly tops: readonly string[];
  readonly all: readonly string[];
}

interface Expansion {
  readonly tops: readonly string[];
  readonly steps: ReadonlyMap<string, Step>;
}

/**
 * Put the steps of its function where the call stands. Arguments that are written out stand for their parameters; all
 * others are worked out once, as the call does it, and kept in variables.
 */
export function expandCall(document: ProgramDocument, id: string, makeId: MakeId): Decision {
  const call = document.steps[id];
  const functionId = textOf(call?.params.function);
  const branch = branchOf(document, id);
  if (call?.kind !== "call" || !(functionId in document.functions) || !branch) return { refused: "nothing" };
  const tree = readTree(document);
  const tops = tree.children(functionId, "body");
  const body: Body = { functionId, tops, all: bodyOf(document, tops) };
  const refused = whyNotExpanded(document, id, body);
  if (refused) return { refused };
  const last = isLastCall(document, id, functionId);
  const expansion = expansionOf(document, call, body, last, makeId);
  const siblings = tree.children(branch.parent, branch.branch);
  const after = siblings[siblings.indexOf(id) - 1] ?? null;
  const room = roomAt(document, { branch, after }, expansion.tops.length, new Set([id]));
  const added = [...expansion.steps].map(([fresh, step]): Edit => {
    const top = expansion.tops.indexOf(fresh);
    const place = top < 0 ? step.place : room.places[top];
    return { do: "add_step", id: fresh, step: { ...moved(step, last ? [0, 0] : [0.5, -0.5]), place } };
  });
  const gone = last ? removeFunction(body) : [];
  return { edits: [...room.shifted, { do: "remove_step", id }, ...gone, ...added] };
}

/** What is left before its end no plain steps can do, and names of the outside must mean the same where the call is. */
function whyNotExpanded(document: ProgramDocument, id: string, { functionId, tops, all }: Body): Refusal | null {
  if (all.some((step) => document.steps[step]?.kind === "return" && step !== tops.at(-1))) return "returns";
  const caller = ancestors(document, id).at(-1) ?? "";
  const near = [...namesOfLoops(document, id), ...(caller in document.functions ? ownNames(document, caller) : [])];
  const own = ownNames(document, functionId);
  const elsewhere = new Map(near.filter((name) => !own.has(name)).map((name) => [name, { param: "" }]));
  const meansOther = all.some((step) => {
    const { params } = document.steps[step] as Step;
    return JSON.stringify(paramsWith(document, step, elsewhere)) !== JSON.stringify(params);
  });
  return meansOther ? "hidden" : null;
}

function bodyOf(document: ProgramDocument, tops: readonly string[]): string[] {
  return [...withDescendants(document, tops)].filter((step) => document.steps[step]);
}

/** Nobody else calls it: the function goes with its last call, as when it had never been made. */
function isLastCall(document: ProgramDocument, id: string, functionId: string): boolean {
  const others = Object.entries(document.steps).filter(([other, step]) => other !== id && step.kind === "call");
  return !document.functions[functionId]?.source && others.every(([, step]) => step.params.function !== functionId);
}

function removeFunction({ functionId, all }: Body): Edit[] {
  return [
    ...all.map((step): Edit => ({ do: "remove_step", id: step })),
    { do: "set_function", id: functionId, value: null },
  ];
}

/** The body copied under fresh ids, behind what sets the arguments that are worked out. */
function expansionOf(
  document: ProgramDocument,
  call: Step,
  { functionId, tops, all }: Body,
  last: boolean,
  makeId: MakeId,
): Expansion {
  const fresh = new Map(all.map((step) => [step, makeId()]));
  const given = givenTo(document, call, functionId, last);
  const steps = new Map<string, Step>();
  for (const [variable, value] of given.set)
    steps.set(makeId(), { kind: "set", place: null, pos: below(call.pos, steps.size), params: { variable, value } });
  const first = [...steps.keys()];
  for (const [old, id] of fresh) {
    const copy = copyOf(document, old, call, fresh, given.values);
    if (copy) steps.set(id, copy);
  }
  const order = tops.map((step) => fresh.get(step) ?? "").filter((step) => steps.has(step));
  return { tops: [...first, ...order], steps };
}

/** A step of the body for its new place; the result goes to the call's variable. */
function copyOf(
  document: ProgramDocument,
  old: string,
  call: Step,
  fresh: ReadonlyMap<string, string>,
  values: ReadonlyMap<string, unknown>,
): Step | null {
  const step = document.steps[old];
  if (!step) return null;
  const params = paramsWith(document, old, values);
  const [parent, branch, order] = step.place ?? ["", "", ""];
  const place = [fresh.get(parent) ?? parent, branch, order] as const;
  if (step.kind !== "return") return { ...step, place, params };
  const variable = call.params.result;
  return typeof variable === "string"
    ? { ...step, kind: "set", place, params: { variable, value: params.value ?? null } }
    : null;
}

interface Given {
  /** Variables that are set before the body, each with its value. */
  readonly set: ReadonlyMap<string, unknown>;
  /** What stands in the body for the function's own names. */
  readonly values: ReadonlyMap<string, unknown>;
}

/**
 * A parameter that the body sets, or whose argument has to be worked out, becomes a variable. A variable that each call
 * had for itself keeps its name where nothing else has it.
 */
function givenTo(document: ProgramDocument, call: Step, functionId: string, last: boolean): Given {
  const args = (call.params.args ?? {}) as Record<string, unknown>;
  const assigned = namesSetIn(document).get(functionId);
  const outside = namesBeside(document, last ? functionId : null);
  const taken = new Set(last ? namesBeside(document, null) : outside);
  const [set, values] = [new Map<string, unknown>(), new Map<string, unknown>()];
  const makeVariable = (name: string): string => {
    const variable = outside.has(name) ? numbered(name, taken) : name;
    taken.add(variable);
    values.set(name, { param: variable });
    return variable;
  };
  const parameters = document.functions[functionId]?.parameters ?? [];
  for (const parameter of parameters) {
    const { name } = parameter;
    const value = writtenOut(ownEntry(args, name) ?? parameter.default ?? null, parameter);
    if (isConstant(value) && !assigned?.has(name)) values.set(name, value);
    else set.set(makeVariable(name), isPlace(value) ? { at: value } : value);
  }
  for (const name of ownNames(document, functionId)) if (!values.has(name)) makeVariable(name);
  return { set, values };
}

/** An argument as it means the same without its parameter: a bare number is in the parameter's unit. */
function writtenOut(value: unknown, { type, unit }: Parameter): unknown {
  if (typeof value === "number" && unit) return { quantity: [value, unit] };
  if (typeof value === "string" && (type === "device" || type === "place")) return { [type]: value };
  return typeof value === "object" && value !== null && "at" in value && isPlace(value.at) ? value.at : value;
}

/** Whether it is the same whenever it is looked at. */
function isConstant(value: unknown): boolean {
  if (Array.isArray(value)) return value.every(isConstant);
  return typeof value !== "object" || value === null || "quantity" in value || "zone" in value || isPlace(value);
}

function isPlace(value: unknown): boolean {
  return typeof value === "object" && value !== null && ["device", "place", "point"].some((key) => key in value);
}
