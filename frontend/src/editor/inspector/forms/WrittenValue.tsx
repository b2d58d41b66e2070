/** One of the step's parameters as a written value. */
import type { Value } from "@/program/document/document";
import { ExpressionField } from "../expression/ExpressionField";
import { useStepEditor } from "../fields/stepEditor";

export function WrittenValue({
  label,
  field,
  wanted,
  placeholder,
}: {
  label: string;
  field: string;
  wanted?: string;
  placeholder?: string;
}) {
  const { id, step, set } = useStepEditor();
  return (
    <ExpressionField
      step={id}
      label={label}
      field={field}
      wanted={wanted}
      placeholder={placeholder}
      value={step.params[field] as Value | undefined}
      onChange={(value) => set(field, value)}
    />
  );
}
