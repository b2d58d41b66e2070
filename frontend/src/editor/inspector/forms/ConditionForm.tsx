/** A condition: chosen as property, comparison, value, several joined by "and" or "or"; or written in one line. */
import { Button, SegmentedControl, Select } from "@mantine/core";
import { ArrowLeftRight, Plus, X } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import type { Value } from "@/program/document/document";
import { readingsOfRoles, reportedBy, robotsFor } from "@/program/robotReadings";
import { roleName } from "@/program/words/valueWords";
import { swapBranches } from "../../edits/branches";
import { type Comparison, fitsForm, joinComparisons, readingsOf, splitComparisons } from "../../edits/conditions";
import { settle } from "../../state/actions";
import { useOpenProgram } from "../../state/context";
import { ExpressionField } from "../expression/ExpressionField";
import { Reading } from "../expression/Readings";
import { SIGNS } from "./signs";
import { FieldFrame, useFieldProblems } from "../fields/FieldFrame";
import { useStepEditor } from "../fields/stepEditor";
import classes from "../../panel.module.css";

/** What stands before a role among the keys of the list; no device's id begins so. */
const ROLE = ":role ";

export function ConditionForm({ field }: { field: string }) {
  const { t: words } = useTranslation();
  const { t } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const value = (step.params[field] ?? null) as Value;
  const fits = fitsForm(value);
  const [writes, setWrites] = useState(!fits);
  const written = writes || !fits;
  return (
    <div className={classes.field}>
      <SegmentedControl
        size="xs"
        aria-label={t("condition.label")}
        disabled={disabled}
        value={written ? "self" : "form"}
        onChange={(next) => setWrites(next === "self")}
        data={[
          { value: "form", label: words("expression.form"), disabled: !fits },
          { value: "self", label: words("expression.self") },
        ]}
      />
      {written ? (
        <ExpressionField
          label={t("condition.label")}
          field={field}
          step={id}
          wanted="boolean"
          value={value}
          onChange={(next) => set(field, next)}
        />
      ) : (
        <ComparisonForm field={field} />
      )}
    </div>
  );
}

function ComparisonForm({ field }: { field: string }) {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const problems = useFieldProblems(field);
  const { joiner, comparisons } = splitComparisons((step.params[field] ?? null) as Value);
  const store = (next: readonly Comparison[], by: "and" | "or" = joiner) => set(field, joinComparisons(next, by));
  const rows = comparisons.length > 0 ? comparisons : [{ left: null, sign: "==", right: null }];
  return (
    <div className={classes.field}>
      <span className={classes.legend}>{t("condition.label")}</span>
      {rows.map((row, index) => (
        <Row
          key={index}
          row={row}
          field={field}
          first={index === 0}
          onChange={(next) => store(rows.map((each, at) => (at === index ? next : each)))}
          onRemove={rows.length > 1 ? () => store(rows.filter((_, at) => at !== index)) : undefined}
        />
      ))}
      {rows.length > 1 ? (
        <SegmentedControl
          className={classes.between}
          size="xs"
          value={joiner}
          disabled={disabled}
          onChange={(next) => store(rows, next)}
          data={[
            { value: "and", label: t("condition.and") },
            { value: "or", label: t("condition.or") },
          ]}
        />
      ) : null}
      {problems.length > 0 ? <p className={classes.problem}>{problems.join(" ")}</p> : null}
      <Button
        variant="subtle"
        size="xs"
        className={classes.between}
        leftSection={<Plus size={14} aria-hidden="true" />}
        disabled={disabled}
        onClick={() => store([...rows, { left: null, sign: "==", right: null }])}
      >
        {t("condition.add")}
      </Button>
    </div>
  );
}

interface RowProps {
  row: Comparison;
  field: string;
  first: boolean;
  onChange: (row: Comparison) => void;
  onRemove?: () => void;
}

function Row(props: RowProps) {
  const { document } = useOpenProgram();
  const [property] = readingsOf(props.row.left, document.roles);
  return (
    <div className={classes.comparison}>
      <LeftField {...props} />
      {property ? <Reading device={property[0]} name={property[1]} /> : null}
      <div className={classes.pair}>
        <SignField {...props} />
        <RightField {...props} />
      </div>
    </div>
  );
}

function LeftField({ row, field, onChange, onRemove }: RowProps) {
  const { t } = useOpenProgram();
  const { disabled } = useStepEditor();
  const groups = useCompared();
  return (
    <FieldFrame label={t("condition.property")} field={`${field}.left`} problems={[]}>
      {({ control }) => (
        <div className={classes.row}>
          <Select
            id={control}
            className={classes.grow}
            data={groups}
            value={keyOf(row.left)}
            onChange={(next) => onChange({ ...row, left: leftFrom(next) })}
            placeholder={t("condition.choose_property")}
            searchable
            disabled={disabled}
          />
          {onRemove ? (
            <IconButton label={t("condition.remove")} onClick={onRemove} disabled={disabled}>
              <X size={15} aria-hidden="true" />
            </IconButton>
          ) : null}
        </div>
      )}
    </FieldFrame>
  );
}

/** The readings of each robot of the program and of each device, and the names that the step can use. */
function useCompared() {
  const { t, devices, document, speaker } = useOpenProgram();
  const { parameters } = useStepEditor();
  const groups = [
    ...readingsOfRoles(document, devices).map(({ role, readings }) => ({
      group: t("condition.of_role", { role: roleName(role, speaker) }),
      items: readings.map((one) => ({
        value: `${ROLE}${role}\n${one.name}`,
        label: `${roleName(role, speaker)} ${one.name}`,
      })),
    })),
    ...devices
      .filter((each) => each.properties.length > 0 && each.lifecycle !== "pending")
      .map((each) => ({
        group: each.name,
        items: each.properties.map((one) => ({ value: `${each.id}\n${one.name}`, label: `${each.name} ${one.name}` })),
      })),
    { group: t("field.parameters"), items: parameters.map((one) => ({ value: `\n${one.name}`, label: one.name })) },
  ];
  return groups.filter((group) => group.items.length > 0);
}

function SignField({ row, field, onChange }: RowProps) {
  const { t } = useOpenProgram();
  const { disabled } = useStepEditor();
  return (
    <FieldFrame label={t("condition.comparison")} field={`${field}.sign`} problems={[]}>
      {({ control }) => (
        <Select
          id={control}
          data={SIGNS}
          value={row.sign}
          onChange={(next) => onChange({ ...row, sign: next ?? "==" })}
          allowDeselect={false}
          disabled={disabled}
        />
      )}
    </FieldFrame>
  );
}

/** What it is compared with: typed as the reading is, with its unit and its range. */
function RightField({ row, field, first, onChange }: RowProps) {
  const { t, devices, document } = useOpenProgram();
  const { id, parameters } = useStepEditor();
  const property = propertyOf(row.left);
  const owners = property?.role
    ? robotsFor(document.roles[property.role], devices)
    : devices.filter((each) => each.id === property?.device);
  const reading = reportedBy(owners).find((each) => each.name === property?.name);
  const name = keyOf(row.left)?.slice(1);
  const facts = reading ?? parameters.find((each) => each.name === name);
  return (
    <ExpressionField
      label={t("condition.value")}
      step={id}
      field={first ? `${field}.right` : `${field}.other`}
      wanted={typeof reading?.value === "string" ? "text" : facts?.type}
      unit={facts?.unit}
      minimum={reading?.minimum}
      maximum={reading?.maximum}
      placeholder={reading ? undefined : t("field.example", { value: "60" })}
      value={row.right}
      onChange={(right) => onChange({ ...row, right })}
    />
  );
}

function propertyOf(left: Value): { device?: string; role?: string; name: string } | null {
  if (typeof left !== "object" || left === null || !("property" in left)) return null;
  const [device, name] = left.property;
  if (typeof device === "string") return { device, name };
  return "role" in device ? { role: device.role, name } : null;
}

function keyOf(left: Value): string | null {
  const property = propertyOf(left);
  if (property?.role) return `${ROLE}${property.role}\n${property.name}`;
  if (property) return `${property.device ?? ""}\n${property.name}`;
  return typeof left === "object" && left !== null && "param" in left ? `\n${left.param}` : null;
}

function leftFrom(key: string | null): Value {
  if (key === null) return null;
  const [device = "", name = ""] = key.split("\n");
  if (device.startsWith(ROLE)) return { property: [{ role: device.slice(ROLE.length) }, name] };
  return device ? { property: [device, name] } : { param: name };
}

export function IfForm() {
  const open = useOpenProgram();
  const { id, disabled } = useStepEditor();
  const { document, scene, t } = open;
  const empty = ["then", "else"].every((branch) => scene.tree.children(id, branch).length === 0);
  return (
    <>
      <ConditionForm field="condition" />
      <Button
        className={classes.between}
        variant="default"
        size="xs"
        leftSection={<ArrowLeftRight size={14} aria-hidden="true" />}
        disabled={disabled || empty}
        onClick={() => settle(open, swapBranches(document, id))}
      >
        {t("gesture.swap")}
      </Button>
    </>
  );
}
