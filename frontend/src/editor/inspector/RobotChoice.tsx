/** By which reading a robot is chosen for a role: "battery > 30 %", or none; what is longer is written in the script. */
import { Button, Select, TextInput } from "@mantine/core";
import { Plus, X } from "lucide-react";
import { useEffect, useState } from "react";
import { IconButton } from "@/design/IconButton";
import type { Role, Value } from "@/program/document/document";
import { reportedBy, robotsFor } from "@/program/robotReadings";
import { valueText } from "@/program/words/valueWords";
import { unitSign } from "@/i18n/units";
import { type Choice, choiceOf, choiceValue, typedValue } from "../edits/choices";
import { useOpenProgram } from "../state/context";
import classes from "../panel.module.css";
import { SIGNS } from "./forms/signs";

interface Props {
  readonly id: string;
  readonly name: string;
  readonly role: Role;
  readonly store: (where: Value) => void;
}

export function RobotChoice({ id, name, role, store }: Props) {
  const { t, canEdit, devices, speaker } = useOpenProgram();
  const readings = reportedBy(robotsFor(role, devices));
  const where = (role.where ?? null) as Value;
  const choice = choiceOf(where, id);
  const [first] = readings;
  if (where === null)
    return (
      <Button
        variant="subtle"
        size="xs"
        className={classes.between}
        leftSection={<Plus size={14} aria-hidden="true" />}
        disabled={!canEdit || !first}
        onClick={() => store(choiceValue({ reading: first?.name ?? "", sign: ">", value: null }, id))}
      >
        {t("role.choose_by")}
      </Button>
    );
  return (
    <div className={classes.field} role="group" aria-label={t("role.where", { role: name })}>
      <div className={classes.row}>
        <span className={`${classes.legend} ${classes.grow}`}>{t("role.only_where")}</span>
        <IconButton label={t("role.choose_any")} onClick={() => store(null)} disabled={!canEdit}>
          <X size={15} aria-hidden="true" />
        </IconButton>
      </div>
      {choice ? (
        <Comparison choice={choice} readings={readings} store={(next) => store(choiceValue(next, id))} />
      ) : (
        <p className={classes.now}>{t("role.where_written", { where: valueText(where, speaker) ?? "?" })}</p>
      )}
    </div>
  );
}

interface ComparisonProps {
  readonly choice: Choice;
  readonly readings: readonly { readonly name: string; readonly type?: string; readonly unit?: string | null }[];
  readonly store: (choice: Choice) => void;
}

function Comparison({ choice, readings, store }: ComparisonProps) {
  const { t, canEdit } = useOpenProgram();
  const facts = readings.find((each) => each.name === choice.reading);
  const known = facts ? readings : [...readings, { name: choice.reading }];
  return (
    <>
      <Select
        aria-label={t("condition.property")}
        data={known.map((each) => each.name)}
        value={choice.reading}
        onChange={(reading) => store({ ...choice, reading: reading ?? choice.reading })}
        allowDeselect={false}
        disabled={!canEdit}
      />
      <div className={classes.pair}>
        <Select
          aria-label={t("condition.comparison")}
          data={SIGNS}
          value={choice.sign}
          onChange={(sign) => store({ ...choice, sign: sign ?? choice.sign })}
          allowDeselect={false}
          disabled={!canEdit}
        />
        <ValueInput choice={choice} type={facts?.type} unit={facts?.unit} store={store} />
      </div>
    </>
  );
}

/** The value as it is being typed; it is kept when the field is left. */
function ValueInput({
  choice,
  type,
  unit,
  store,
}: {
  choice: Choice;
  type?: string;
  unit?: string | null;
  store: (choice: Choice) => void;
}) {
  const { t, canEdit } = useOpenProgram();
  const stored = choice.value === null ? "" : String(choice.value);
  const [text, setText] = useState(stored);
  useEffect(() => setText(stored), [stored]);
  const keep = () => {
    const value = typedValue(text, type);
    if (value === choice.value) setText(stored);
    else store({ ...choice, value });
  };
  return (
    <TextInput
      aria-label={t("condition.value")}
      value={text}
      placeholder={type === "number" ? t("field.example", { value: "30" }) : undefined}
      rightSection={unit ? <span className={classes.legend}>{unitSign(unit)}</span> : undefined}
      disabled={!canEdit}
      onChange={(event) => setText(event.currentTarget.value)}
      onBlur={keep}
      onKeyDown={(event) => event.key === "Enter" && keep()}
    />
  );
}
