/** Whether somebody changed after me what my last gesture set, so that undoing it would undo theirs, too. */
import type { Edit } from "./edits";
import type { ProgramDocument } from "@/program/document/document";

/** What the edits set, by field; the last one counts. */
function fieldsOf(edits: readonly Edit[]): ReadonlyMap<string, Edit> {
  const fields = new Map<string, Edit>();
  for (const edit of edits) {
    const id = "id" in edit ? edit.id : "";
    const name = edit.do === "set_param" ? edit.name : "";
    if (edit.do !== "add_step" && edit.do !== "remove_step") fields.set(JSON.stringify([edit.do, id, name]), edit);
  }
  return fields;
}

export function changedSince(document: ProgramDocument, edits: readonly Edit[]): boolean {
  return [...fieldsOf(edits).values()].some((edit) => {
    const [now, mine] = valuesOf(document, edit);
    return now !== undefined && JSON.stringify(now ?? null) !== JSON.stringify(mine ?? null);
  });
}

/** The field as it is now and as the edit set it; undefined where the step has gone. */
function valuesOf(document: ProgramDocument, edit: Edit): readonly [now: unknown, mine: unknown] {
  switch (edit.do) {
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
