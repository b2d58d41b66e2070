/** What a run is told when it starts: the program's parameters, with their defaults. */
import { NumberInput, Select, TextInput } from "@mantine/core";
import type { Parameter } from "@/program/document/document";
import { unitText } from "@/program/words/stepWords";
import { useOpenProgram } from "../state/context";

export type Given = Readonly<Record<string, unknown>>;

/** What is given, with the defaults for the rest; null while something must still be said. */
export function completed(parameters: readonly Parameter[], given: Given): Given | null {
  const all = parameters.map(({ name, default: usual }) => [name, given[name] ?? usual ?? null] as const);
  return all.some(([, value]) => value === null) ? null : Object.fromEntries(all);
}

export function RunParameters({ given, onGive }: { given: Given; onGive: (given: Given) => void }) {
  const { document } = useOpenProgram();
  return Object.entries(document.parameters).map(([id, parameter]) => (
    <ParameterInput
      key={id}
      parameter={parameter}
      value={given[parameter.name] ?? parameter.default ?? null}
      onChange={(value) => onGive({ ...given, [parameter.name]: value })}
    />
  ));
}

interface InputProps {
  parameter: Parameter;
  value: unknown;
  onChange: (value: unknown) => void;
}

function ParameterInput({ parameter, value, onChange }: InputProps) {
  const unit = unitText(parameter.unit);
  const label = unit ? `${parameter.name} (${unit})` : parameter.name;
  if (parameter.type === "number")
    return (
      <NumberInput
        label={label}
        value={typeof value === "number" ? value : ""}
        onChange={(next) => onChange(typeof next === "number" ? next : null)}
      />
    );
  if (parameter.type === "text" || parameter.type === "object")
    return (
      <TextInput
        label={label}
        value={typeof value === "string" ? value : ""}
        onChange={(event) => onChange(event.currentTarget.value || null)}
      />
    );
  return <Choice label={label} type={parameter.type} value={value} onChange={onChange} />;
}

/** Yes or no, a machine, or a place. */
function Choice({
  label,
  type,
  value,
  onChange,
}: {
  label: string;
  type: string;
  value: unknown;
  onChange: (value: unknown) => void;
}) {
  const { t, devices, plan } = useOpenProgram();
  const yesNo = [
    { value: "true", label: t("value.true") },
    { value: "false", label: t("value.false") },
  ];
  const places = type === "place" ? (plan?.places ?? []).map((place) => ({ value: place.id, label: place.name })) : [];
  const machines = devices
    .filter((device) => device.kind !== "robot")
    .map((device) => ({ value: device.id, label: device.name }));
  return (
    <Select
      label={label}
      data={type === "boolean" ? yesNo : [...machines, ...places]}
      value={typeof value === "boolean" ? String(value) : typeof value === "string" ? value : null}
      onChange={(next) => onChange(type === "boolean" && next !== null ? next === "true" : next)}
      placeholder={t("field.choose")}
      searchable={type !== "boolean"}
    />
  );
}
