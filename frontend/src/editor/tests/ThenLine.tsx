/** One thing that a test expects, as a sentence with fields. */
import { Autocomplete, Select, TagsInput, TextInput } from "@mantine/core";
import { Check, Trash2, X } from "lucide-react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import { NumberField } from "@/design/NumberField";
import { ROBOT_STEPS } from "@/program/operation";
import type { Choice, Startable } from "@/shell/start/startable";
import { objectsOf, ReadingValue } from "./GivenLine";
import { COMPARISONS, isWhole, type ThenRow } from "./testRows";
import type { Scalar } from "./testText";
import classes from "./testForm.module.css";

interface ThenLineProps {
  row: ThenRow;
  number: number;
  about: Startable;
  steps: readonly Choice[];
  /** What came of it; null: nobody knows. */
  holds: boolean | null;
  onChange: (row: ThenRow) => void;
  /** Null: the last one, and a test expects something. */
  onRemove: (() => void) | null;
}

export function ThenLine({ row, number, holds, onRemove, ...rest }: ThenLineProps) {
  const { t } = useTranslation();
  return (
    <li
      className={classes.line}
      data-part={!isWhole.then(row) || undefined}
      aria-label={t("tests.form.line", { number })}
    >
      {holds === null ? null : holds ? (
        <Check size={14} className={classes.holds} aria-label={t("tests.holds")} />
      ) : (
        <X size={14} className={classes.fails} aria-label={t("tests.fails")} />
      )}
      <Says row={row} {...rest} />
      {onRemove ? (
        <IconButton label={t("tests.form.remove", { number })} onClick={onRemove}>
          <Trash2 size={14} aria-hidden="true" />
        </IconButton>
      ) : null}
    </li>
  );
}

type Says = Omit<ThenLineProps, "number" | "holds" | "onRemove">;
type Value = ThenRow["says"][string];

interface FieldsProps extends Says {
  set: (change: ThenRow["says"]) => void;
}

function Says(props: Says) {
  const { t } = useTranslation();
  const { row, onChange } = props;
  const fields: FieldsProps = {
    ...props,
    set: (change) => onChange({ ...row, says: { ...row.says, ...change }, written: null }),
  };
  switch (row.kind) {
    case "ends":
      return <span>{t("tests.form.then_kind.ends")}</span>;
    case "other":
      return <span>{t("tests.form.only_text", { text: JSON.stringify(row.written) })}</span>;
    case "fails":
      return <Fails {...fields} />;
    case "within_s":
      return <Within {...fields} />;
    case "item":
      return <Item {...fields} />;
    case "step":
      return <Step {...fields} />;
    case "commands":
      return <Commands {...fields} />;
    case "property":
      return <Property {...fields} />;
    case "zone":
      return <Zone {...fields} />;
    case "near":
      return <Near {...fields} />;
  }
}

const textOf = (value: Value | undefined) => (typeof value === "string" ? value : null);
const numberOf = (value: Value | undefined) => (typeof value === "number" ? value : "");

/** The choices with the one that is written, though there is no such thing any more. */
function withWritten(choices: readonly Choice[], value: string | null): Choice[] {
  return value === null || choices.some((each) => each.value === value)
    ? [...choices]
    : [...choices, { value, label: value }];
}

function Fails({ row, set }: FieldsProps) {
  const { t } = useTranslation();
  return (
    <>
      <span>{t("tests.form.fails_with")}</span>
      <TextInput
        size="xs"
        aria-label={t("tests.form.reason")}
        placeholder={t("tests.form.reason")}
        maxLength={200}
        value={textOf(row.says.value) ?? ""}
        onChange={(event) => set({ value: event.currentTarget.value })}
      />
    </>
  );
}

interface CountProps {
  label: string;
  value: Value | undefined;
  suffix?: string;
  placeholder?: string;
  onChange: (value: number | null) => void;
}

function CountField({ label, value, suffix = "", placeholder, onChange }: CountProps) {
  return (
    <NumberField
      size="xs"
      className={classes.short}
      aria-label={label}
      placeholder={placeholder ?? label}
      min={0}
      suffix={suffix}
      value={numberOf(value)}
      onChange={(next) => onChange(typeof next === "number" ? next : null)}
    />
  );
}

function Within({ row, set }: FieldsProps) {
  const { t } = useTranslation();
  return (
    <>
      <span>{t("tests.form.ends_within")}</span>
      <CountField
        label={t("tests.form.seconds")}
        suffix=" s"
        value={row.says.value}
        onChange={(value) => set({ value })}
      />
    </>
  );
}

function Item({ row, set, about }: FieldsProps) {
  const { t } = useTranslation();
  const at = textOf(row.says.at);
  const machines = about.devices.map(({ id, name }) => ({ value: id, label: name }));
  return (
    <>
      <Select
        size="xs"
        aria-label={t("tests.form.device")}
        placeholder={t("tests.form.device")}
        data={withWritten(machines, at)}
        value={at}
        searchable
        onChange={(next) => set({ at: next })}
      />
      <span>{t("tests.form.holds_at_end")}</span>
      <CountField
        label={t("tests.form.count")}
        placeholder={t("tests.form.any")}
        value={row.says.count}
        onChange={(count) => set({ count })}
      />
      <Autocomplete
        size="xs"
        aria-label={t("tests.form.object")}
        placeholder={t("tests.form.object")}
        data={objectsOf(about.devices)}
        value={textOf(row.says.object) ?? ""}
        onChange={(object) => set({ object })}
      />
    </>
  );
}

function Step({ row, set, steps }: FieldsProps) {
  const { t } = useTranslation();
  const step = textOf(row.says.step);
  return (
    <>
      <Select
        size="xs"
        className={classes.long}
        aria-label={t("tests.form.step")}
        placeholder={t("tests.form.step")}
        data={withWritten(steps, step)}
        value={step}
        searchable
        onChange={(next) => set({ step: next })}
      />
      <span>{t("tests.form.is_begun")}</span>
      <CountField
        label={t("tests.form.times")}
        placeholder={t("tests.form.any")}
        suffix="×"
        value={row.says.times}
        onChange={(times) => set({ times })}
      />
    </>
  );
}

function Commands({ row, set, about }: FieldsProps) {
  const { t } = useTranslation();
  const known = about.devices.flatMap(({ id, methods }) => methods.map(({ name }) => `${id}.${name}`));
  return (
    <>
      <span>{t("tests.form.in_order")}</span>
      <TagsInput
        size="xs"
        className={classes.long}
        aria-label={t("tests.form.commands")}
        placeholder={t("tests.form.commands")}
        data={[...new Set([...ROBOT_STEPS, ...known])]}
        value={Array.isArray(row.says.value) ? [...(row.says.value as string[])] : []}
        allowDuplicates
        onChange={(value) => set({ value })}
      />
    </>
  );
}

function Property({ row, set, about }: FieldsProps) {
  const { t } = useTranslation();
  const [device, name] = [textOf(row.says.device), textOf(row.says.name)];
  const properties = about.devices.find(({ id }) => id === device)?.properties ?? [];
  const property = properties.find((each) => each.name === name);
  const choices = about.devices
    .filter((each) => each.properties.length > 0)
    .map((each) => ({ value: each.id, label: each.name }));
  const value = row.says.value ?? null;
  return (
    <>
      <Select
        size="xs"
        aria-label={t("tests.form.device")}
        placeholder={t("tests.form.device")}
        data={withWritten(choices, device)}
        value={device}
        searchable
        onChange={(next) => set({ device: next, name: null, value: null })}
      />
      <Select
        size="xs"
        aria-label={t("tests.form.reading")}
        placeholder={t("tests.form.reading")}
        data={withWritten(
          properties.map((each) => ({ value: each.name, label: each.name })),
          name,
        )}
        value={name}
        disabled={device === null}
        onChange={(next) => {
          const isNumber = properties.find((each) => each.name === next)?.type === "number";
          set({ name: next, value: null, compared: isNumber ? "at_least" : "is" });
        }}
      />
      <Select
        size="xs"
        className={classes.short}
        aria-label={t("tests.form.compared")}
        data={COMPARISONS.map((each) => ({ value: each, label: t(`tests.form.comparison.${each}`) }))}
        value={textOf(row.says.compared)}
        allowDeselect={false}
        onChange={(compared) => set({ compared })}
      />
      <ReadingValue
        property={property}
        value={Array.isArray(value) ? null : (value as Scalar | null)}
        onChange={(next) => set({ value: next })}
      />
    </>
  );
}

function Zone({ row, set, about }: FieldsProps) {
  const { t } = useTranslation();
  const zone = textOf(row.says.zone);
  const names = Object.values(about.document.zones ?? {}).map(({ name }) => ({ value: name, label: name }));
  return (
    <>
      <span>{t("tests.form.never_two_in")}</span>
      <Select
        size="xs"
        aria-label={t("tests.form.zone")}
        placeholder={t("tests.form.zone")}
        data={withWritten(names, zone)}
        value={zone}
        nothingFoundMessage={t("tests.form.no_zones")}
        onChange={(next) => set({ zone: next })}
      />
    </>
  );
}

function Near({ row, set, about }: FieldsProps) {
  const { t } = useTranslation();
  const place = textOf(row.says.place);
  const machines = about.devices.filter(({ kind }) => kind === "machine");
  const choices = [...about.places, ...machines].map(({ id, name }) => ({ value: id, label: name }));
  return (
    <>
      <span>{t("tests.form.never_two_within")}</span>
      <CountField
        label={t("tests.form.metres")}
        suffix=" m"
        value={row.says.within_m}
        onChange={(within_m) => set({ within_m })}
      />
      <span>{t("tests.form.of")}</span>
      <Select
        size="xs"
        aria-label={t("tests.form.place")}
        placeholder={t("tests.form.place")}
        data={withWritten(choices, place)}
        value={place}
        searchable
        onChange={(next) => set({ place: next })}
      />
    </>
  );
}
