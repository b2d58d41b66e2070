/** One parameter of a function or of the program: name, type, unit, and what it is when nobody says. */
import { ActionIcon, Select, TextInput } from "@mantine/core";
import { Trash2 } from "lucide-react";
import { NumberField } from "@/design/NumberField";
import { asName } from "../../edits/variables";
import type { Parameter } from "@/program/document/document";
import { UNIT_CHOICES } from "@/i18n/units";
import { useOpenProgram } from "../../state/context";
import { NamedField } from "./NamedField";
import classes from "../../panel.module.css";

export const TYPES = ["number", "text", "boolean", "object", "device", "place"] as const;
/** Types whose default can be written down. */
const PLAIN = ["number", "text", "boolean", "object"];

export interface ParameterCardProps {
  parameter: Parameter;
  disabled: boolean;
  onChange: (parameter: Parameter) => void;
  onRemove: () => void;
}

export function ParameterCard({ parameter, disabled, onChange, onRemove }: ParameterCardProps) {
  const { t } = useOpenProgram();
  const retype = (type: string) => onChange({ name: parameter.name, type });
  return (
    <div className={classes.comparison} role="group" aria-label={parameter.name}>
      <div className={classes.row}>
        <span className={classes.grow}>
          <NamedField
            label={t("call.parameter_name")}
            hidden
            value={parameter.name}
            disabled={disabled}
            clean={asName}
            onChange={(name) => onChange({ ...parameter, name })}
          />
        </span>
        <ActionIcon
          variant="subtle"
          color="gray"
          size={34}
          aria-label={t("call.remove_parameter", { name: parameter.name })}
          onClick={onRemove}
          disabled={disabled}
        >
          <Trash2 size={15} aria-hidden="true" />
        </ActionIcon>
      </div>
      <TypeFields
        name={parameter.name}
        type={parameter.type}
        unit={parameter.unit}
        disabled={disabled}
        onType={retype}
        onUnit={(unit) => onChange({ ...parameter, unit })}
      />
      {PLAIN.includes(parameter.type) ? (
        <Default parameter={parameter} disabled={disabled} onChange={onChange} />
      ) : null}
    </div>
  );
}

/** A type, and for numbers the unit. */
export function TypeFields({
  name,
  type,
  unit,
  none,
  disabled,
  onType,
  onUnit,
}: {
  name: string;
  type: string;
  unit?: string | null;
  /** What stands first for "no type". */
  none?: string;
  disabled: boolean;
  onType: (type: string) => void;
  onUnit: (unit: string | null) => void;
}) {
  const { t } = useOpenProgram();
  const types = TYPES.map((each) => ({ value: each, label: t(`type.${each}`) }));
  return (
    <div className={classes.pair}>
      <Select
        aria-label={t("call.parameter_type", { name })}
        data={none ? [{ value: "", label: none }, ...types] : types}
        value={type}
        onChange={(next) => onType(next ?? type)}
        allowDeselect={false}
        disabled={disabled}
      />
      {type === "number" ? <UnitSelect name={name} unit={unit} disabled={disabled} onUnit={onUnit} /> : null}
    </div>
  );
}

export function UnitSelect({
  name,
  unit,
  disabled,
  onUnit,
}: {
  name: string;
  unit?: string | null;
  disabled: boolean;
  onUnit: (unit: string | null) => void;
}) {
  const { t } = useOpenProgram();
  return (
    <Select
      aria-label={t("parameter.unit", { name })}
      data={[...UNIT_CHOICES]}
      value={unit || null}
      onChange={onUnit}
      placeholder={t("parameter.no_unit")}
      searchable
      clearable
      disabled={disabled}
    />
  );
}

function Default({ parameter, disabled, onChange }: Omit<ParameterCardProps, "onRemove">) {
  const { t } = useOpenProgram();
  const shared = {
    "aria-label": t("parameter.default", { name: parameter.name }),
    placeholder: t("parameter.no_default"),
    disabled,
  };
  const store = (value: string | number | boolean | null) => {
    const { name, type, unit } = parameter;
    onChange({ name, type, ...(unit ? { unit } : {}), ...(value === null ? {} : { default: value }) });
  };
  if (parameter.type === "number")
    return (
      <NumberField
        {...shared}
        value={typeof parameter.default === "number" ? parameter.default : ""}
        onChange={(next) => store(typeof next === "number" ? next : null)}
      />
    );
  if (parameter.type === "boolean")
    return (
      <Select
        {...shared}
        data={[
          { value: "yes", label: t("value.true") },
          { value: "no", label: t("value.false") },
        ]}
        value={typeof parameter.default === "boolean" ? (parameter.default ? "yes" : "no") : null}
        onChange={(next) => store(next === null ? null : next === "yes")}
        clearable
      />
    );
  return (
    <TextInput
      {...shared}
      value={typeof parameter.default === "string" ? parameter.default : ""}
      onChange={(event) => store(event.currentTarget.value || null)}
    />
  );
}
