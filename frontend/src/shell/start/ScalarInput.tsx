/** A field for one value: a number, yes or no, or a text; null while nothing is filled in. */
import { Select, TextInput } from "@mantine/core";
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { NumberField } from "@/design/NumberField";

interface ScalarInputProps {
  /** `number`, `boolean`, or anything else for a text. */
  type: string;
  value: unknown;
  onChange: (value: string | number | boolean | null) => void;
  label?: string;
  "aria-label"?: string;
  placeholder?: string;
  error?: ReactNode;
  disabled?: boolean;
  size?: "xs";
  className?: string;
  /** What stands behind a number. */
  suffix?: string;
}

const LONGEST_TEXT = 200;

export function ScalarInput({ type, value, onChange, suffix, className, ...field }: ScalarInputProps) {
  const { t } = useTranslation();
  if (type === "number")
    return (
      <NumberField
        {...field}
        className={className}
        suffix={suffix}
        value={typeof value === "number" ? value : ""}
        onChange={(next) => onChange(typeof next === "number" ? next : null)}
      />
    );
  if (type === "boolean")
    return (
      <Select
        {...field}
        className={className}
        placeholder={field.placeholder ?? t("editor.field.choose")}
        data={["true", "false"].map((each) => ({ value: each, label: t(`editor.value.${each}`) }))}
        value={typeof value === "boolean" ? String(value) : null}
        onChange={(next) => onChange(next === null ? null : next === "true")}
      />
    );
  return (
    <TextInput
      {...field}
      maxLength={LONGEST_TEXT}
      value={typeof value === "string" ? value : ""}
      onChange={(event) => onChange(event.currentTarget.value || null)}
    />
  );
}
