/** The fields of a step of each kind. */
import type { ReactNode } from "react";
import type { StepKind } from "@/program/document/document";
import { isStepKind } from "@/program/kinds";
import { CallForm } from "./CallForm";
import { AskForm } from "./AskForm";
import { IfForm } from "./ConditionForm";
import { ConstructForm } from "./ConstructForm";
import { ForEachForm, ReturnForm } from "./flowForms";
import { TryForm } from "./TryForm";
import { LoadForm } from "./LoadForm";
import { OperateForm } from "./OperateForm";
import { ParallelForm, WaitForm } from "./smallForms";

/** Forms in which fields depend on each other; all others follow from the records of constructs. */
const FORMS: Readonly<Partial<Record<StepKind, () => ReactNode>>> = {
  pick_and_drop: LoadForm,
  pick: LoadForm,
  drop: LoadForm,
  operate: OperateForm,
  wait: WaitForm,
  if: IfForm,
  for_each: ForEachForm,
  parallel: ParallelForm,
  try: TryForm,
  call: CallForm,
  ask: AskForm,
  return: ReturnForm,
};

export function StepForm({ kind }: { kind: string }) {
  if (!isStepKind(kind)) return null;
  const Chosen = FORMS[kind] ?? ConstructForm;
  return <Chosen />;
}
