/** One thing that is given when a test begins: what a machine holds, what a robot carries, what a reading shows. */
import { Autocomplete, Select } from "@mantine/core";
import { Trash2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { Device } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { NumberField } from "@/design/NumberField";
import { unitSign } from "@/i18n/units";
import { ScalarInput } from "@/shell/start/ScalarInput";
import { type GivenRow, isWhole } from "./testRows";
import classes from "./testForm.module.css";

interface GivenLineProps {
  row: GivenRow;
  number: number;
  devices: readonly Device[];
  onChange: (row: GivenRow) => void;
  onRemove: () => void;
}

export function GivenLine({ row, number, devices, onChange, onRemove }: GivenLineProps) {
  const { t } = useTranslation();
  const set = (change: Partial<GivenRow>) => onChange({ ...row, ...change });
  return (
    <li
      className={classes.line}
      data-part={!isWhole.given(row) || undefined}
      aria-label={t("tests.form.line", { number })}
    >
      <Select
        size="xs"
        aria-label={t("tests.form.device")}
        data={fitting(row, devices)}
        value={row.device}
        placeholder={t("tests.form.device")}
        searchable
        onChange={(device) => set(row.kind === "readings" ? { device, name: null, value: null } : { device })}
      />
      <span>{t(`tests.form.given_does.${row.kind}`)}</span>
      {row.kind === "readings" ? (
        <Reading row={row} devices={devices} set={set} />
      ) : (
        <>
          <NumberField
            size="xs"
            className={classes.short}
            aria-label={t("tests.form.count")}
            placeholder="1"
            min={0}
            allowDecimal={false}
            value={typeof row.value === "number" ? row.value : ""}
            onChange={(next) => set({ value: typeof next === "number" ? next : null })}
          />
          <Autocomplete
            size="xs"
            aria-label={t("tests.form.object")}
            placeholder={t("tests.form.object")}
            data={objectsOf(devices)}
            value={row.name ?? ""}
            onChange={(name) => set({ name: name || null })}
          />
        </>
      )}
      <IconButton label={t("tests.form.remove", { number })} onClick={onRemove}>
        <Trash2 size={14} aria-hidden="true" />
      </IconButton>
    </li>
  );
}

function fitting({ kind, device }: GivenRow, devices: readonly Device[]) {
  const suits = (each: Device) =>
    kind === "readings" ? each.properties.length > 0 : (each.kind === "robot") === (kind === "carrying");
  const found = devices.filter((each) => each.id === device || (each.lifecycle === "approved" && suits(each)));
  const choices = found.map(({ id, name }) => ({ value: id, label: name }));
  return device === null || found.some(({ id }) => id === device)
    ? choices
    : [...choices, { value: device, label: device }];
}

/** What the machines of the site give and take. */
export function objectsOf(devices: readonly Device[]): string[] {
  return [...new Set(devices.flatMap(({ gives, takes }) => [...gives, ...takes]))].sort();
}

interface ReadingProps {
  row: GivenRow;
  devices: readonly Device[];
  set: (change: Partial<GivenRow>) => void;
}

function Reading({ row, devices, set }: ReadingProps) {
  const { t } = useTranslation();
  const property = devices.find(({ id }) => id === row.device)?.properties.find(({ name }) => name === row.name);
  const names = devices.find(({ id }) => id === row.device)?.properties.map(({ name }) => name) ?? [];
  return (
    <>
      <Select
        size="xs"
        aria-label={t("tests.form.reading")}
        placeholder={t("tests.form.reading")}
        data={row.name === null || names.includes(row.name) ? names : [...names, row.name]}
        value={row.name}
        disabled={row.device === null}
        onChange={(name) => set({ name, value: null })}
      />
      <ReadingValue property={property} value={row.value} onChange={(value) => set({ value })} />
    </>
  );
}

interface ValueProps {
  /** What the device says of the reading, if it has it. */
  property: Device["properties"][number] | undefined;
  value: GivenRow["value"];
  onChange: (value: GivenRow["value"]) => void;
}

/** A value of a reading: a number with its unit, yes or no, or a text. */
export function ReadingValue({ property, value, onChange }: ValueProps) {
  const { t } = useTranslation();
  const type = property?.type ?? typeof value;
  const unit = unitSign(property?.unit);
  const label = t("tests.form.value");
  return (
    <ScalarInput
      size="xs"
      className={type === "number" || type === "boolean" ? classes.short : undefined}
      aria-label={label}
      placeholder={label}
      suffix={unit ? ` ${unit}` : ""}
      {...{ type, value, onChange }}
    />
  );
}
