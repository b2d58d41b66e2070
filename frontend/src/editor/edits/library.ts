/** Functions of the library brought into a document, with ids of their own. */
import { ownEntry } from "@/design/ownEntry";
import type { Edit } from "./edits";
import type { FunctionDefinition, ProgramDocument, Role, Step, Zone } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { ancestors } from "@/program/document/tree";
import { deleteSteps, type MakeId } from "./joints";
import { paramsWithIds, withIds } from "./substitution";

/** A function cut out of a program: its body and the functions that it calls. */
export interface CutOut {
  readonly id: string;
  readonly function: FunctionDefinition;
  readonly functions: Readonly<Record<string, FunctionDefinition>>;
  readonly steps: Readonly<Record<string, Step>>;
  /** Those that the steps name; versions that were saved before have none. */
  readonly roles?: Readonly<Record<string, Role>>;
  readonly zones?: Readonly<Record<string, Zone>>;
}

export interface Imported {
  readonly edits: readonly Edit[];
  readonly functionId: string;
}

/** The function that the document already has from this version of the library, if any. */
export function alreadyImported(document: ProgramDocument, library: string, version: number): string | null {
  const found = Object.entries(document.functions).find(
    ([, definition]) => definition.source?.library === library && definition.source.version === version,
  );
  return found?.[0] ?? null;
}

export interface Source {
  readonly library: string;
  readonly version: number;
}

/** Roles and zones that the document has just so are taken as they are; the others come in with ids of their own. */
export function importFunction(
  document: ProgramDocument,
  cut: CutOut,
  source: Source,
  makeId: MakeId,
  functionId = makeId(),
): Imported {
  const fresh = new Map<string, string>([[cut.id, functionId]]);
  for (const id of [...Object.keys(cut.functions), ...Object.keys(cut.steps)]) fresh.set(id, makeId());
  const renamed = (id: string) => fresh.get(id) ?? id;
  const others = (["roles", "zones"] as const).flatMap((root) =>
    Object.entries<Role | Zone>(cut[root] ?? {})
      .filter(([id, value]) => !isSameValue(document[root][id], value))
      .map(([id, value]) => ({ root, id, value })),
  );
  for (const { root, id } of others) if (document[root][id]) fresh.set(id, makeId());
  // A role may name itself, so they are written once all new ids are known.
  const named = others.map(({ root, id, value }) => {
    const kind = root === "roles" ? "set_role" : "set_zone";
    return { do: kind, id: renamed(id), value: withIds(value, renamed) } as Edit;
  });
  const steps = Object.entries(cut.steps).map(([id, step]): Edit => ({
    do: "add_step",
    id: renamed(id),
    step: renameStep(step, renamed),
  }));
  const parts = Object.entries(cut.functions).map(([id, value]): Edit => ({
    do: "set_function",
    id: renamed(id),
    value,
  }));
  return {
    functionId,
    edits: [{ do: "set_function", id: functionId, value: { ...cut.function, source } }, ...parts, ...named, ...steps],
  };
}

/**
 * The function's definition and body as another version of the library has them; its calls stay. The functions go that
 * came with the version that is held, by their names there, and that nothing else calls. Where nobody knows that
 * version any more, the names in the new one count.
 */
export function replaceFunction(
  document: ProgramDocument,
  functionId: string,
  cut: CutOut,
  source: Source,
  makeId: MakeId,
  former: CutOut = cut,
): readonly Edit[] {
  if (!document.functions[functionId]) return [];
  const names = new Set(Object.values(former.functions).map(({ name }) => name));
  const old = partsOfOnly(document, functionId, names);
  const emptied = new Set([functionId, ...old]);
  const bodies = Object.keys(document.steps).filter((id) => emptied.has(document.steps[id]?.place?.[0] ?? ""));
  return [
    ...deleteSteps(document, bodies),
    ...old.map((id): Edit => ({ do: "set_function", id, value: null })),
    ...importFunction(document, cut, source, makeId, functionId).edits,
  ];
}

/** The functions of these names that a function calls, itself or by others, and that nothing else calls. */
function partsOfOnly(document: ProgramDocument, functionId: string, names: ReadonlySet<string>): string[] {
  const calls = callsOf(document);
  const all = reached(calls, [functionId], () => true);
  const parts = new Set(
    [...all].filter((id) => id !== functionId && names.has(ownEntry(document.functions, id)?.name ?? "")),
  );
  const elsewhere = [...calls].filter(([owner]) => owner !== functionId && !parts.has(owner));
  const called = elsewhere.flatMap(([, ids]) => ids).filter((id) => parts.has(id));
  const kept = reached(calls, called, (id) => parts.has(id));
  return [...parts].filter((id) => !kept.has(id));
}

/** Which functions are called below each function, the program and each draft. */
function callsOf(document: ProgramDocument): ReadonlyMap<string, readonly string[]> {
  const calls = new Map<string, string[]>();
  for (const [id, { kind, params }] of Object.entries(document.steps)) {
    if (kind !== "call" || typeof params.function !== "string") continue;
    const owner = ancestors(document, id).at(-1) ?? id;
    calls.set(owner, [...(calls.get(owner) ?? []), params.function]);
  }
  return calls;
}

/** These and all that they call, one by another, as far as it is wanted. */
function reached(
  calls: ReadonlyMap<string, readonly string[]>,
  from: readonly string[],
  isWanted: (id: string) => boolean,
): ReadonlySet<string> {
  const found = new Set(from);
  for (const each of found) for (const id of calls.get(each) ?? []) if (isWanted(id)) found.add(id);
  return found;
}

function renameStep(step: Step, renamed: (id: string) => string): Step {
  return {
    ...step,
    place: step.place ? [renamed(step.place[0]), step.place[1], step.place[2]] : null,
    params: paramsWithIds(step.params, renamed),
  };
}
