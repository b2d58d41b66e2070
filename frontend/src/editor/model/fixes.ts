/** A problem's remedy as edits of the document. */
import type { Edit } from "./edits";
import { deleteSteps, placeAtEnd } from "./gestures";
import { PROGRAM } from "./tree";
import type { Fix, ProgramDocument } from "./types";

/** `field` is a parameter's name, `args.name` inside one, or "place" / "" for the step itself. */
export function fixEdits(document: ProgramDocument, fix: Fix): readonly Edit[] {
  const { step: id, field, value } = fix;
  const step = document.steps[id];
  if (!step) return [];
  if (field === "place") return [{ do: "set_place", id, place: placeAtEnd(document, PROGRAM) }];
  if (field === "") return value === null ? deleteSteps(document, [id]) : [];
  const [name = "", inner] = field.split(".", 2);
  if (inner === undefined) return [{ do: "set_param", id, name, value }];
  const whole = { ...(step.params[name] as Record<string, unknown> | undefined), [inner]: value };
  return [{ do: "set_param", id, name, value: whole }];
}
