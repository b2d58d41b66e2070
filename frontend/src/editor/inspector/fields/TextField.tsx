/** Plain text of several lines, kept when the field is left. */
import { Textarea } from "@mantine/core";
import { useEffect, useState } from "react";
import { FieldFrame } from "./FieldFrame";
import { useStepEditor } from "./stepEditor";

export function TextField({ label, field, placeholder }: { label: string; field: string; placeholder?: string }) {
  const { step, set, disabled } = useStepEditor();
  const stored = typeof step.params[field] === "string" ? step.params[field] : "";
  const [text, setText] = useState(stored);
  useEffect(() => setText(stored), [stored]);
  return (
    <FieldFrame label={label} field={field}>
      {({ control }) => (
        <Textarea
          id={control}
          autosize
          minRows={3}
          maxRows={12}
          value={text}
          placeholder={placeholder}
          disabled={disabled}
          onChange={(event) => setText(event.currentTarget.value)}
          onBlur={() => (text === stored ? undefined : set(field, text))}
        />
      )}
    </FieldFrame>
  );
}
