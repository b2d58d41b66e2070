/** Whether somebody changed after me what I set last, so that undoing or redoing it would overwrite theirs. */
import { applyEdits, type Edit } from "./edits";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { readStep } from "@/program/document/wellFormed";

/** What the edits set, by field; the last one counts. Whether a step is there is one, too. */
function fieldsOf(edits: readonly Edit[]): ReadonlyMap<string, Edit> {
  const fields = new Map<string, Edit>();
  for (const edit of edits) {
    const id = "id" in edit ? edit.id : "";
    const name = edit.do === "set_param" ? edit.name : "";
    const field = edit.do === "add_step" || edit.do === "remove_step" ? "step" : edit.do;
    fields.set(JSON.stringify([field, id, name]), edit);
  }
  return fields;
}

export function changedSince(document: ProgramDocument, edits: readonly Edit[]): boolean {
  return [...fieldsOf(edits).values()].some((edit) => {
    const [now, mine] = valuesOf(document, edit);
    return now !== undefined && !isSameValue(now ?? null, mine ?? null);
  });
}

/**
 * Whether what the edits added has more in it than they gave it: a step another field or steps of others inside, a
 * function steps or calls of others. Edits that make a function say first that it is not there.
 */
export function workedOnSince(document: ProgramDocument, edits: readonly Edit[]): boolean {
  const steps = new Map<string, Step>();
  const placed = new Set<string>();
  const away = new Set<string>();
  const made = new Set<unknown>();
  for (const edit of edits) {
    if (!("id" in edit)) continue;
    const { id } = edit;
    if (edit.do === "set_function") {
      if (!edit.value) away.add(id);
      else if (away.has(id)) made.add(id);
      continue;
    }
    placed.add(id);
    const before = steps.get(id);
    const step = applyEdits({ ...EMPTY_DOCUMENT, steps: before ? { [id]: before } : {} }, [edit]).steps[id];
    if (step) steps.set(id, step);
    else steps.delete(id);
  }
  return (
    [...steps].some(([id, mine]) => {
      const now = document.steps[id];
      return now !== undefined && !isSameValue(now, readStep(mine));
    }) ||
    Object.entries(document.steps).some(([id, { place, params }]) => {
      const parent = place?.[0] ?? "";
      return !placed.has(id) && (steps.has(parent) || made.has(parent) || made.has(params.function));
    })
  );
}

/** Edits that set the fields of these as they are now; a step that is away has none. */
export function asTheyAre(document: ProgramDocument, edits: readonly Edit[]): readonly Edit[] {
  return [...fieldsOf(edits).values()].flatMap((edit) => {
    if (edit.do === "add_step" || edit.do === "remove_step") return presence(document, edit.id);
    const [now] = valuesOf(document, edit);
    if (now === undefined) return edit;
    const field =
      edit.do === "set_place" ? "place" : edit.do === "set_pos" || edit.do === "set_start" ? "pos" : "value";
    const set = { ...edit, [field]: now };
    return edit.do === "set_function" && !edit.value ? [edit, set] : set;
  });
}

function presence({ steps }: ProgramDocument, id: string): Edit {
  const step = steps[id];
  return step ? { do: "add_step", id, step } : { do: "remove_step", id };
}

/** The field as it is now and as the edit set it; undefined where the step has gone, or was added by it. */
function valuesOf(document: ProgramDocument, edit: Edit): readonly [now: unknown, mine: unknown] {
  switch (edit.do) {
    case "remove_step":
      return [document.steps[edit.id], null];
    case "set_place":
      return [document.steps[edit.id]?.place, edit.place];
    case "set_pos":
      return [document.steps[edit.id]?.pos, edit.pos];
    case "set_param": {
      const step = document.steps[edit.id];
      return [step && (step.params[edit.name] ?? null), edit.value];
    }
    case "set_function":
      return [document.functions[edit.id] ?? null, edit.value];
    case "set_role":
      return [document.roles[edit.id] ?? null, edit.value];
    case "set_parameter":
      return [document.parameters[edit.id] ?? null, edit.value];
    case "set_zone":
      return [document.zones[edit.id] ?? null, edit.value];
    case "set_start":
      return [document.start_pos, edit.pos];
    default:
      return [undefined, undefined];
  }
}
