/** A problem's remedy as edits of the document. */
import type { Edit } from "./edits";
import { deleteSteps, joinDrafts } from "./gestures";
import type { Fix, ProgramDocument } from "./types";

/** `field` is a parameter's name, `args.name` inside one, or "place" / "" for the step itself. */
export function fixEdits(document: ProgramDocument, fix: Fix): readonly Edit[] {
  const { step: id, field, value } = fix;
  const step = document.steps[id];
  if (!step) return [];
  if (field === "place") return joined(document, id);
  if (field === "") return value === null ? deleteSteps(document, [id]) : [];
  const [name = "", inner] = field.split(".", 2);
  if (inner === undefined) return [{ do: "set_param", id, name, value }];
  const whole = { ...(step.params[name] as Record<string, unknown> | undefined), [inner]: value };
  return [{ do: "set_param", id, name, value: whole }];
}

function joined(document: ProgramDocument, id: string): readonly Edit[] {
  const decision = joinDrafts(document, [id]);
  return "edits" in decision ? decision.edits : [];
}
