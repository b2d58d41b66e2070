/** A field for a number, with the decimal sign of the screen's language; point and comma may both be typed or pasted. */
// oxlint-disable-next-line no-restricted-imports -- all others take this one
import { NumberInput, type NumberInputProps } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";

interface NumberFieldProps extends Omit<NumberInputProps, "value" | "onChange"> {
  value: number | string;
  /** Told the number that stands there so far, also of `2.` and `2.0`; empty where none does. */
  onChange: (value: number | "") => void;
}

export function NumberField({ value, onChange, onBlur, ...field }: NumberFieldProps) {
  const { language } = useTranslation().i18n;
  /** What was typed to get the present number: `2.0` is on the way to `2.05`. */
  const [typed, setTyped] = useState(value);
  const change = (next: number | string) => {
    const begun = typeof next === "string" ? next.replace(/^(-?)\./, "$10.") : next;
    setTyped(begun);
    if (meant(begun) !== value) onChange(meant(begun));
  };
  return (
    <NumberInput
      {...field}
      decimalSeparator={new Intl.NumberFormat(language).format(0.5).charAt(1)}
      value={meant(typed) === value ? typed : value}
      onChange={change}
      onBlur={(event) => {
        setTyped("");
        onBlur?.(event);
      }}
    />
  );
}

function meant(typed: number | string): number | "" {
  const number = typeof typed === "number" ? typed : Number.parseFloat(typed);
  return Number.isNaN(number) ? "" : number;
}
