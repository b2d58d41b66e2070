/** Edits of a document as data: gestures decide them, the shared document applies them. */
import type {
  FunctionDefinition,
  Parameter,
  Position,
  ProgramDocument,
  Role,
  Step,
  Zone,
} from "@/program/document/document";

export type StepPlace = readonly [parent: string, branch: string, order: string];

export type Edit =
  | { readonly do: "add_step"; readonly id: string; readonly step: Step }
  | { readonly do: "remove_step"; readonly id: string }
  | { readonly do: "set_place"; readonly id: string; readonly place: StepPlace | null }
  | { readonly do: "set_pos"; readonly id: string; readonly pos: Position }
  | { readonly do: "set_param"; readonly id: string; readonly name: string; readonly value: unknown }
  | { readonly do: "set_function"; readonly id: string; readonly value: FunctionDefinition | null }
  | { readonly do: "set_role"; readonly id: string; readonly value: Role | null }
  | { readonly do: "set_parameter"; readonly id: string; readonly value: Parameter | null }
  | { readonly do: "set_zone"; readonly id: string; readonly value: Zone | null }
  | { readonly do: "set_start"; readonly pos: Position };

/** Why a gesture changes nothing; a key of the catalogue. */
export type Refusal =
  | "cycle"
  | "one_branch"
  | "event"
  | "drafts"
  | "no_frame"
  | "not_inside"
  | "returns"
  | "hidden"
  | "gone"
  | "nothing";

/** A gesture's outcome: what to change, or why nothing changes. */
export type Decision = { readonly edits: readonly Edit[] } | { readonly refused: Refusal };

/** What the document is after the edits; the original stays as it is. */
export function applyEdits(document: ProgramDocument, edits: readonly Edit[]): ProgramDocument {
  return edits.reduce(applyEdit, document);
}

function applyEdit(document: ProgramDocument, edit: Edit): ProgramDocument {
  switch (edit.do) {
    case "add_step":
      return { ...document, steps: { ...document.steps, [edit.id]: edit.step } };
    case "remove_step":
      return { ...document, steps: without(document.steps, edit.id) };
    case "set_place":
      return changeStep(document, edit.id, (step) => ({ ...step, place: edit.place }));
    case "set_pos":
      return changeStep(document, edit.id, (step) => ({ ...step, pos: edit.pos }));
    case "set_param":
      return changeStep(document, edit.id, (step) => ({
        ...step,
        params: withValue(step.params, edit.name, edit.value),
      }));
    case "set_function":
      return { ...document, functions: withValue(document.functions, edit.id, edit.value) };
    case "set_role":
      return { ...document, roles: withValue(document.roles, edit.id, edit.value) };
    case "set_parameter":
      return { ...document, parameters: withValue(document.parameters, edit.id, edit.value) };
    case "set_zone":
      return { ...document, zones: withValue(document.zones, edit.id, edit.value) };
    case "set_start":
      return { ...document, start_pos: edit.pos };
  }
}

function changeStep(document: ProgramDocument, id: string, change: (step: Step) => Step): ProgramDocument {
  const step = document.steps[id];
  return step ? { ...document, steps: { ...document.steps, [id]: change(step) } } : document;
}

function withValue<T>(record: Readonly<Record<string, T>>, key: string, value: T | null | undefined) {
  return value === null || value === undefined ? without(record, key) : { ...record, [key]: value };
}

function without<T>(record: Readonly<Record<string, T>>, key: string): Record<string, T> {
  return Object.fromEntries(Object.entries(record).filter(([name]) => name !== key));
}
