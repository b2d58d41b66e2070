/** The inspector's fields: a label, a control, and the problems under it. */
import { ActionIcon, NumberInput, Select, TextInput, Tooltip } from "@mantine/core";
import { CircleAlert, Crosshair, FunctionSquare, TriangleAlert } from "lucide-react";
import { useId, type FocusEvent, type ReactNode } from "react";
import type { Place, Value } from "../model/types";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { unitText } from "../scene/words";
import classes from "./inspector.module.css";
import { useStepEditor } from "./stepEditor";

/** Errors whose field is this one, or inside it. */
export function useFieldProblems(field: string): readonly string[] {
  return useFieldMessages(field, "error");
}

function useFieldMessages(field: string, severity: "error" | "warning"): readonly string[] {
  const { diagnostics } = useOpenProgram();
  const { id } = useStepEditor();
  return diagnostics
    .filter((each) => each.step === id && each.severity === severity)
    .filter((each) => each.field === field || each.field.startsWith(`${field}.`))
    .map((each) => each.message);
}

export function FieldFrame({
  label,
  field,
  problems,
  children,
}: {
  label: string;
  field: string;
  problems?: readonly string[];
  children: (ids: { control: string; note: string; bad: boolean }) => ReactNode;
}) {
  const control = useId();
  const found = useFieldProblems(field);
  const warnings = useFieldMessages(field, "warning");
  const messages = problems ?? found;
  const { showEditing } = useStepEditor();
  const leave = (event: FocusEvent) => {
    if (!event.currentTarget.contains(event.relatedTarget)) showEditing(false);
  };
  return (
    <div className={classes.field} onFocus={() => showEditing(true)} onBlur={leave}>
      <label htmlFor={control}>{label}</label>
      {children({ control, note: `${control}-note`, bad: messages.length > 0 })}
      {messages.length > 0 ? (
        <p className={classes.problem} id={`${control}-note`}>
          <CircleAlert size={14} aria-hidden="true" />
          <span>{messages.join(" ")}</span>
        </p>
      ) : null}
      {warnings.length > 0 ? (
        <p className={classes.warning}>
          <TriangleAlert size={14} aria-hidden="true" />
          <span>{warnings.join(" ")}</span>
        </p>
      ) : null}
    </div>
  );
}

type MachineFilter = (device: { gives: string[]; takes: string[]; methods: { name: string }[] }) => boolean;

/** A device, a named place, or a parameter; the map can be pressed instead. */
export function PlaceField({
  label,
  field,
  accept = () => true,
  places = false,
  value,
  onChange,
}: {
  label: string;
  field: string;
  accept?: MachineFilter;
  places?: boolean;
  value: Place | null;
  onChange: (place: Place | null) => void;
}) {
  const { devices, plan, t } = useOpenProgram();
  const { parameters, disabled } = useStepEditor();
  const machines = devices.filter((device) => device.kind !== "robot" && device.lifecycle !== "pending");
  const groups = [
    {
      group: t("field.machines"),
      items: machines.map((device) => ({
        value: `device:${device.id}`,
        label: device.name,
        disabled: !accept(device),
      })),
    },
    {
      group: t("field.places"),
      items: places ? (plan?.places ?? []).map((place) => ({ value: `place:${place.id}`, label: place.name })) : [],
    },
    {
      group: t("field.parameters"),
      items: parameters.map((parameter) => ({ value: `param:${parameter.name}`, label: parameter.name })),
    },
    { group: t("field.point"), items: pointItems(value) },
  ].filter((group) => group.items.length > 0);
  const pick = () => useUi.setState({ fieldPick: { field, choose: (device: string) => onChange({ device }) } });
  return (
    <FieldFrame label={label} field={field}>
      {({ control, note, bad }) => (
        <div className={classes.row}>
          <Select
            id={control}
            aria-describedby={bad ? note : undefined}
            error={bad}
            className={classes.grow}
            data={groups}
            value={placeKey(value)}
            onChange={(next) => onChange(placeFrom(next, value))}
            placeholder={t("field.choose")}
            searchable
            nothingFoundMessage={t("palette.none")}
            disabled={disabled}
            comboboxProps={{ withinPortal: true }}
          />
          <Tooltip label={t("field.pick_on_map")}>
            <ActionIcon
              variant="default"
              size={34}
              aria-label={t("field.pick_on_map")}
              onClick={pick}
              disabled={disabled}
            >
              <Crosshair size={16} aria-hidden="true" />
            </ActionIcon>
          </Tooltip>
        </div>
      )}
    </FieldFrame>
  );
}

function pointItems(value: Place | null): { value: string; label: string }[] {
  if (!value || !("point" in value)) return [];
  return [{ value: "point", label: `${value.point[0]}, ${value.point[1]} m` }];
}

function placeKey(place: Place | null): string | null {
  if (!place) return null;
  if ("device" in place) return `device:${place.device}`;
  if ("place" in place) return `place:${place.place}`;
  return "point" in place ? "point" : `param:${place.param}`;
}

function placeFrom(key: string | null, before: Place | null): Place | null {
  if (key === null) return null;
  const [kind, ...rest] = key.split(":");
  const id = rest.join(":");
  if (kind === "device") return { device: id };
  if (kind === "place") return { place: id };
  return kind === "param" ? { param: id } : before;
}

/** A number, a text or a choice; inside a function also one of its parameters. */
export function ValueField({
  label,
  field,
  value,
  onChange,
  type = "number",
  unit,
  minimum,
  maximum,
  options,
  placeholder,
}: {
  label: string;
  field: string;
  value: Value | undefined;
  onChange: (value: Value) => void;
  type?: string;
  unit?: string | null;
  minimum?: number | null;
  maximum?: number | null;
  options?: readonly unknown[] | null;
  placeholder?: string;
}) {
  const { parameters, disabled } = useStepEditor();
  const { t } = useOpenProgram();
  const param = typeof value === "object" && value !== null && "param" in value ? value.param : null;
  const numeric = /^(number|integer|float|double|decimal|int|time|duration)$/i.test(type);
  return (
    <FieldFrame label={label} field={field}>
      {({ control, note, bad }) => {
        const shared = {
          id: control,
          "aria-describedby": bad ? note : undefined,
          error: bad,
          disabled,
          className: classes.grow,
          placeholder,
        };
        return (
          <div className={classes.row}>
            {param !== null ? (
              <Select
                {...shared}
                data={parameters.map((each) => each.name)}
                value={param}
                onChange={(next) => onChange(next ? { param: next } : null)}
              />
            ) : type === "boolean" ? (
              <Select
                {...shared}
                data={[
                  { value: "true", label: t("value.true") },
                  { value: "false", label: t("value.false") },
                ]}
                value={typeof value === "boolean" ? String(value) : null}
                onChange={(next) => onChange(next === null ? null : next === "true")}
                clearable
              />
            ) : options && options.length > 0 ? (
              <Select
                {...shared}
                data={options.map(String)}
                value={typeof value === "string" ? value : null}
                onChange={(next) => onChange(next)}
              />
            ) : numeric ? (
              <NumberInput
                {...shared}
                value={typeof value === "number" ? value : ""}
                onChange={(next) => onChange(typeof next === "number" ? next : null)}
                min={minimum ?? undefined}
                max={maximum ?? undefined}
                clampBehavior="none"
                suffix={unit ? `\u202f${unitText(unit)}` : undefined}
              />
            ) : (
              <TextInput
                {...shared}
                value={typeof value === "string" ? value : ""}
                onChange={(event) => onChange(event.currentTarget.value || null)}
              />
            )}
            {parameters.length > 0 ? (
              <Tooltip label={t(param === null ? "field.use_parameter" : "field.use_value")}>
                <ActionIcon
                  variant="default"
                  size={34}
                  disabled={disabled}
                  aria-label={t(param === null ? "field.use_parameter" : "field.use_value")}
                  aria-pressed={param !== null}
                  onClick={() => onChange(param === null ? { param: parameters[0]?.name ?? "" } : null)}
                >
                  <FunctionSquare size={16} aria-hidden="true" />
                </ActionIcon>
              </Tooltip>
            ) : null}
          </div>
        );
      }}
    </FieldFrame>
  );
}
