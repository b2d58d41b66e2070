/** The step in the inspector, for its fields. */
import { createContext, use } from "react";
import type { Parameter, Step } from "@/program/document/document";

export interface StepEditor {
  readonly id: string;
  readonly step: Step;
  /** Names that the step can read, nearest first: loop variables, parameters, what is set. */
  readonly parameters: readonly Parameter[];
  readonly disabled: boolean;
  readonly set: (name: string, value: unknown) => void;
  /** Tell the others that somebody is in this step's fields. */
  readonly showEditing: (editing: boolean) => void;
}

export const StepEditorContext = createContext<StepEditor | null>(null);

export function useStepEditor(): StepEditor {
  const editor = use(StepEditorContext);
  if (!editor) throw new Error("This field belongs inside the inspector of a step.");
  return editor;
}
