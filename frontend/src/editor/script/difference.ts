/** What makes one document of another, as edits: only what differs, so that other people's edits of the rest stay. */
import type { Edit } from "../edits/edits";
import type { ProgramDocument, Step } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";

/** The edits that turn `base` into `next`; applied to a document that went on meanwhile, they change only that. */
export function differenceOf(base: ProgramDocument, next: ProgramDocument): readonly Edit[] {
  return [
    ...recordEdits(base.roles, next.roles, (id, value) => ({ do: "set_role", id, value })),
    ...recordEdits(base.functions, next.functions, (id, value) => ({ do: "set_function", id, value })),
    ...recordEdits(base.parameters, next.parameters, (id, value) => ({
      do: "set_parameter",
      id,
      value,
    })),
    ...recordEdits(base.zones, next.zones, (id, value) => ({ do: "set_zone", id, value })),
    ...Object.entries(next.steps).flatMap(([id, step]) => stepEdits(id, base.steps[id], step)),
    ...Object.keys(base.steps)
      .filter((id) => !next.steps[id])
      .map((id): Edit => ({ do: "remove_step", id })),
  ];
}

function recordEdits<T>(
  base: Readonly<Record<string, T>>,
  next: Readonly<Record<string, T>>,
  edit: (id: string, value: T | null) => Edit,
): Edit[] {
  const changed = Object.entries(next).filter(([id, value]) => !isSameValue(base[id], value));
  const gone = Object.keys(base).filter((id) => next[id] === undefined);
  return [...changed.map(([id, value]) => edit(id, value)), ...gone.map((id) => edit(id, null))];
}

function stepEdits(id: string, before: Step | undefined, step: Step): Edit[] {
  if (!before) return [{ do: "add_step", id, step }];
  if (before.kind !== step.kind)
    return [
      { do: "remove_step", id },
      { do: "add_step", id, step },
    ];
  const edits: Edit[] = [];
  if (!isSameValue(before.place ?? null, step.place ?? null))
    edits.push({ do: "set_place", id, place: step.place ?? null });
  if (step.pos && !isSameValue(before.pos ?? null, step.pos)) edits.push({ do: "set_pos", id, pos: step.pos });
  for (const name of new Set([...Object.keys(before.params), ...Object.keys(step.params)]))
    if (!isSameValue(before.params[name] ?? null, step.params[name] ?? null))
      edits.push({ do: "set_param", id, name, value: step.params[name] ?? null });
  return edits;
}

export interface Drawn {
  readonly document: ProgramDocument;
  /** The step of each line of the script. */
  readonly lines: readonly string[];
}

/** The drawn document with ids of this browser's own for what is new: two people may draw at the same time. */
export function withFreshIds(drawn: Drawn, base: ProgramDocument, makeId: () => string): Drawn {
  const { document } = drawn;
  const steps = freshIds(Object.keys(document.steps), base.steps, makeId);
  const functions = freshIds(Object.keys(document.functions), base.functions, makeId);
  const rename = (id: string) => steps.get(id) ?? functions.get(id) ?? id;
  const renamed = Object.entries(document.steps).map(([id, step]) => [steps.get(id) ?? id, renamedStep(step)] as const);

  function renamedStep(step: Step): Step {
    const place = step.place ? ([rename(step.place[0]), step.place[1], step.place[2]] as const) : step.place;
    const called = step.kind === "call" ? functions.get(String(step.params.function)) : undefined;
    return { ...step, place, params: called ? { ...step.params, function: called } : step.params };
  }

  return {
    document: {
      ...document,
      steps: Object.fromEntries(renamed),
      functions: Object.fromEntries(
        Object.entries(document.functions).map(([id, value]) => [functions.get(id) ?? id, value]),
      ),
    },
    lines: drawn.lines.map((id) => steps.get(id) ?? id),
  };
}

function freshIds(ids: readonly string[], known: Readonly<Record<string, unknown>>, makeId: () => string) {
  return new Map(ids.filter((id) => known[id] === undefined).map((id) => [id, makeId()]));
}
