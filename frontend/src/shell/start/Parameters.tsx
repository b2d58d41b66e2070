/** What a run or a rehearsal is told when it starts: the program's parameters, with their defaults. */
import { Select } from "@mantine/core";
import { useTranslation } from "react-i18next";
import type { Device } from "@/api/types";
import type { MapPlace } from "@/map/floor/floor";
import type { Parameter } from "@/program/document/document";
import { unitSign } from "@/i18n/units";
import { ownEntry } from "@/design/ownEntry";
import { ScalarInput } from "./ScalarInput";

const SCALARS = ["number", "boolean", "text", "object"];

export type Given = Readonly<Record<string, unknown>>;

/** What is given, with the defaults for the rest; null while something must still be said. */
export function completed(parameters: readonly Parameter[], given: Given): Given | null {
  const all = parameters.map(({ name, default: usual }) => [name, ownEntry(given, name) ?? usual ?? null] as const);
  return all.some(([, value]) => value === null) ? null : Object.fromEntries(all);
}

interface ParametersProps {
  parameters: readonly Parameter[];
  devices: readonly Device[];
  places: readonly MapPlace[];
  given: Given;
  onGive: (given: Given) => void;
  /** What is wrong with a parameter, by its name. */
  errors?: Readonly<Record<string, string>>;
}

export function Parameters({ parameters, given, onGive, errors = {}, ...around }: ParametersProps) {
  return parameters.map((parameter) => (
    <ParameterInput
      key={parameter.name}
      {...around}
      parameter={parameter}
      value={ownEntry(given, parameter.name) ?? parameter.default ?? null}
      error={ownEntry(errors, parameter.name)}
      onChange={(value) => onGive({ ...given, [parameter.name]: value })}
    />
  ));
}

interface InputProps extends Pick<ParametersProps, "devices" | "places"> {
  parameter: Parameter;
  value: unknown;
  error: string | undefined;
  onChange: (value: unknown) => void;
}

function ParameterInput(props: InputProps) {
  const { parameter, value, error, onChange } = props;
  const unit = unitSign(parameter.unit);
  const label = unit ? `${parameter.name} (${unit})` : parameter.name;
  if (SCALARS.includes(parameter.type))
    return <ScalarInput type={parameter.type} {...{ label, value, error, onChange }} />;
  return <OneOf {...props} label={label} />;
}

/** A machine, or a place. */
function OneOf({
  label,
  parameter: { type },
  value,
  error,
  onChange,
  devices,
  places,
}: InputProps & { label: string }) {
  const { t } = useTranslation();
  const named = type === "place" ? places.map((place) => ({ value: place.id, label: place.name })) : [];
  const machines = devices
    .filter((device) => device.kind !== "robot")
    .map((device) => ({ value: device.id, label: device.name }));
  return (
    <Select
      {...{ label, error }}
      data={[...machines, ...named]}
      value={typeof value === "string" ? value : null}
      onChange={onChange}
      placeholder={t("editor.field.choose")}
      searchable
    />
  );
}
