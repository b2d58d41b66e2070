/** Functions made of steps, and calls turned back into the steps of their function. */
import { ownEntry } from "@/design/ownEntry";
import { moved, toCentimetre } from "./clipping";
import type { Decision, Edit } from "./edits";
import { type Position, type ProgramDocument, type Step, textOf } from "@/program/document/document";
import { branchOf, neighbours, roomAt, type MakeId } from "./joints";
import { paramsWith } from "./substitution";
import { EVENTS, readTree, withDescendants } from "@/program/document/tree";

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
    pos: below(document, steps),
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
function below(document: ProgramDocument, ids: readonly string[]): Position {
  const positions = ids.map((id) => document.steps[id]?.pos ?? [0, 0]);
  const across = positions.reduce((sum, [x]) => sum + x, 0) / Math.max(1, positions.length);
  return [toCentimetre(across), toCentimetre(Math.min(...positions.map(([, y]) => y)) - 0.9)];
}

interface Expansion {
  readonly tops: readonly string[];
  readonly steps: ReadonlyMap<string, Step>;
}

/** Put the steps of its function where the call stands, with the call's arguments for the parameters. */
export function expandCall(document: ProgramDocument, id: string, makeId: MakeId): Decision {
  const call = document.steps[id];
  const functionId = textOf(call?.params.function);
  const branch = branchOf(document, id);
  if (call?.kind !== "call" || !(functionId in document.functions) || !branch) return { refused: "nothing" };
  const expansion = expansionOf(document, call, functionId, makeId);
  if (!expansion) return { refused: "returns" };
  const siblings = readTree(document).children(branch.parent, branch.branch);
  const after = siblings[siblings.indexOf(id) - 1] ?? null;
  const room = roomAt(document, { branch, after }, expansion.tops.length, new Set([id]));
  const last = isLastCall(document, id, functionId);
  const added = [...expansion.steps].map(([fresh, step]): Edit => {
    const top = expansion.tops.indexOf(fresh);
    const place = top < 0 ? step.place : room.places[top];
    return { do: "add_step", id: fresh, step: { ...moved(step, last ? [0, 0] : [0.5, -0.5]), place } };
  });
  const gone = last ? removeFunction(document, functionId) : [];
  return { edits: [...room.shifted, { do: "remove_step", id }, ...gone, ...added] };
}

/** Nobody else calls it: the function goes with its last call, as when it had never been made. */
function isLastCall(document: ProgramDocument, id: string, functionId: string): boolean {
  const others = Object.entries(document.steps).filter(([other, step]) => other !== id && step.kind === "call");
  return !document.functions[functionId]?.source && others.every(([, step]) => step.params.function !== functionId);
}

function removeFunction(document: ProgramDocument, functionId: string): Edit[] {
  const body = withDescendants(document, readTree(document).children(functionId, "body"));
  return [
    ...[...body].map((step): Edit => ({ do: "remove_step", id: step })),
    { do: "set_function", id: functionId, value: null },
  ];
}

/** The body copied under fresh ids; null where it is left before its end, which no plain steps can do. */
function expansionOf(document: ProgramDocument, call: Step, functionId: string, makeId: MakeId): Expansion | null {
  const tops = readTree(document).children(functionId, "body");
  const all = [...withDescendants(document, tops)];
  const returns = all.filter((step) => document.steps[step]?.kind === "return");
  if (returns.some((step) => step !== tops.at(-1))) return null;
  const fresh = new Map(all.map((step) => [step, makeId()]));
  const given = argumentsOf(document, call, functionId, all);
  const steps = new Map<string, Step>();
  for (const [name, value] of given.set)
    steps.set(makeId(), { kind: "set", place: null, pos: call.pos, params: { variable: name, value } });
  const first = [...steps.keys()];
  for (const [old, id] of fresh) {
    const copy = copyOf(document, old, call, fresh, given.replace);
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
  const params = paramsWith(document, old, step, values);
  const [parent, branch, order] = step.place ?? ["", "", ""];
  const place = [fresh.get(parent) ?? parent, branch, order] as const;
  if (step.kind !== "return") return { ...step, place, params };
  const variable = call.params.result;
  return typeof variable === "string"
    ? { ...step, kind: "set", place, params: { variable, value: params.value ?? null } }
    : null;
}

/** Parameters that the body sets anew keep their names and get their value first; the others are replaced. */
function argumentsOf(
  document: ProgramDocument,
  call: Step,
  functionId: string,
  body: readonly string[],
): { set: ReadonlyMap<string, unknown>; replace: ReadonlyMap<string, unknown> } {
  const args = (call.params.args ?? {}) as Record<string, unknown>;
  const params = body.map((step) => document.steps[step]?.params ?? {});
  const assigned = new Set(params.flatMap(({ variable, result }) => [variable, result]));
  const set = new Map<string, unknown>();
  const replace = new Map<string, unknown>();
  for (const { name, default: usual } of document.functions[functionId]?.parameters ?? [])
    (assigned.has(name) ? set : replace).set(name, ownEntry(args, name) ?? usual ?? null);
  return { set, replace };
}
