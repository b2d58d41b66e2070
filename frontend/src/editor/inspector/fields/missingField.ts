/** The first value that a step cannot do without and does not have. */
import { useEffect, useRef } from "react";
import type { ProgramDocument, Step } from "@/program/document/document";
import { type FieldRecord, fieldsOf } from "@/program/kinds";
import { methodOf } from "@/program/operation";
import type { Surroundings } from "@/program/surroundings";
import { ownEntry } from "@/design/ownEntry";
import { useOpenProgram } from "../../state/context";
import { useUi } from "../../state/ui";

/** What is written; a place is pressed on the map, and a condition is chosen, often after what it decides is drawn. */
function isWritten({ type, wanted, optional }: FieldRecord): boolean {
  return !optional && (type === "text" || type === "variable" || (type === "value" && wanted !== "boolean"));
}

export function missingField(step: Step, surroundings: Surroundings, document: ProgramDocument): string | null {
  const empty = (value: unknown) => value === undefined || value === null || value === "";
  const field = fieldsOf(step.kind).find((each) => isWritten(each) && empty(step.params[each.name]));
  if (field) return field.name;
  if (step.kind !== "operate") return null;
  const args = (step.params.args ?? {}) as Record<string, unknown>;
  const { method } = methodOf(step, surroundings, document);
  const asked = method?.parameters.find(({ name, required }) => required !== false && empty(ownEntry(args, name)));
  return asked ? `args.${asked.name}` : null;
}

/** A field that needs a value has the keyboard at once: that of the step which this person has just made. */
export function useFreshField(id: string): void {
  const { document: program, surroundings, canEdit } = useOpenProgram();
  const fresh = useUi((ui) => ui.fresh === id);
  const asked = useRef<string | null>(null);
  useEffect(() => {
    const step = fresh && canEdit ? program.steps[id] : undefined;
    // Once, when the step is made: what is changed of it later takes nobody's keyboard.
    if (!step || asked.current === id) return;
    asked.current = id;
    const field = missingField(step, surroundings, program);
    const box = field && document.querySelector(`[data-form] [data-field="${CSS.escape(field)}"]`);
    if (box) box.querySelector<HTMLElement>("input, textarea")?.focus();
  }, [fresh, id, program, surroundings, canEdit]);
}
