/** A text that is kept when the field is left, not at each letter. */
import { TextInput } from "@mantine/core";
import { useEffect, useState } from "react";

export function NamedField({
  label,
  value,
  hidden = false,
  disabled,
  placeholder,
  clean = (text) => text.trim(),
  onChange,
}: {
  label: string;
  value: string;
  /** The label is only read aloud. */
  hidden?: boolean;
  disabled: boolean;
  placeholder?: string;
  clean?: (text: string) => string;
  onChange: (value: string) => void;
}) {
  const [text, setText] = useState(value);
  useEffect(() => setText(value), [value]);
  return (
    <TextInput
      label={hidden ? undefined : label}
      aria-label={hidden ? label : undefined}
      value={text}
      disabled={disabled}
      placeholder={placeholder}
      onChange={(event) => setText(event.currentTarget.value)}
      onBlur={() => {
        const next = clean(text);
        if (next && next !== value) onChange(next);
        else setText(value);
      }}
    />
  );
}
