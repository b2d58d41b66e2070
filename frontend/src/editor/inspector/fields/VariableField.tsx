/** The name of a variable: one that is known, or a new one. */
import { Autocomplete } from "@mantine/core";
import { useEffect, useState } from "react";
import { asName, namesSet } from "../../edits/variables";
import { functionOf } from "@/program/scene/stepPaths";
import { useOpenProgram } from "../../state/context";
import { FieldFrame } from "./FieldFrame";
import { useStepEditor } from "./stepEditor";

export function VariableField({
  label,
  field,
  placeholder,
  optional = false,
}: {
  label: string;
  field: string;
  placeholder?: string;
  optional?: boolean;
}) {
  const { document, t } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const stored = typeof step.params[field] === "string" ? step.params[field] : "";
  const [text, setText] = useState(stored);
  useEffect(() => setText(stored), [stored]);
  const scope = functionOf(document, id);
  const names = [...(scope ? namesSet(document, scope) : []), ...namesSet(document, null)];
  const keep = (next: string) => {
    const name = asName(next);
    if (name === stored) setText(stored);
    else if (name || optional) set(field, name || null);
    else setText(stored);
  };
  return (
    <FieldFrame label={label} field={field}>
      {({ control, note, bad }) => (
        <Autocomplete
          id={control}
          aria-describedby={bad ? note : undefined}
          error={bad}
          data={[...new Set(names.map((each) => each.name))].sort()}
          value={text}
          placeholder={placeholder ?? t("field.variable_example")}
          disabled={disabled}
          onChange={setText}
          onOptionSubmit={keep}
          onBlur={() => keep(text)}
        />
      )}
    </FieldFrame>
  );
}
