/** The form of a kind of step: a field for each thing that it is told, by its record. */
import type { ReactNode } from "react";
import type { Place } from "@/program/document/document";
import { type FieldRecord, fieldsOf, isDriving } from "@/program/kinds";
import { useOpenProgram } from "../../state/context";
import classes from "../../panel.module.css";
import { ChoiceField } from "../fields/ChoiceField";
import { MessageField } from "../fields/MessageField";
import { type MachineFilter, PlaceField } from "../fields/PlaceField";
import { RoleField } from "../fields/RoleField";
import { RouteField } from "../fields/RouteField";
import { useStepEditor } from "../fields/stepEditor";
import { TextField } from "../fields/TextField";
import { VariableField } from "../fields/VariableField";
import { ZoneField } from "../fields/ZoneField";
import { WrittenValue } from "./WrittenValue";
import { ConditionForm } from "./ConditionForm";

export function ConstructForm() {
  const { t } = useOpenProgram();
  const { step } = useStepEditor();
  const fields = fieldsOf(step.kind).filter((field) => field.type in FIELDS);
  const note = t(`form.${step.kind}.note`, { defaultValue: "" });
  return (
    <>
      {fields.map(({ name }) => (
        <StepField key={name} name={name} />
      ))}
      {isDriving(step.kind) ? (
        <>
          {fields.length > 0 ? <hr className={classes.line} /> : null}
          <RoleField />
          <RouteField />
        </>
      ) : null}
      {note ? <p className={classes.now}>{note}</p> : null}
    </>
  );
}

/** One field of the step, by its record. */
export function StepField({ name }: { name: string }) {
  const { t } = useOpenProgram();
  const { step } = useStepEditor();
  const field = fieldsOf(step.kind).find((each) => each.name === name);
  const Shown = field && FIELDS[field.type];
  if (!Shown) return null;
  const words = `form.${step.kind}`;
  const example = t(`${words}.${name}_example`, { defaultValue: "" }) || undefined;
  return <Shown field={field} words={words} label={t(`${words}.${name}`, { defaultValue: "" })} example={example} />;
}

interface Shown {
  field: FieldRecord;
  /** Where its words stand in the catalogue. */
  words: string;
  label: string;
  example?: string;
}

const FIELDS: Readonly<Record<string, (shown: Shown) => ReactNode>> = {
  place: PlaceOfStep,
  value: ValueOfStep,
  variable: ({ field, label, example }) => (
    <VariableField label={label} field={field.name} optional={field.optional} placeholder={example} />
  ),
  choice: ({ field, label, words }) => (
    <ChoiceField
      label={label}
      field={field.name}
      choices={field.choices ?? []}
      words={words}
      explained={field.explained}
    />
  ),
  zone: ({ field, label }) => <ZoneField label={label} field={field.name} />,
  text: ({ field, label, example }) => <TextField label={label} field={field.name} placeholder={example} />,
};

function ValueOfStep({ field: { name, wanted }, label, example }: Shown) {
  if (wanted === "boolean") return <ConditionForm field={name} />;
  if (wanted === "text") return <MessageField label={label} field={name} placeholder={example} />;
  const kind = wanted === "time" || wanted === "length" ? "number" : wanted;
  return <WrittenValue label={label} field={name} wanted={kind} placeholder={example} />;
}

const SUITS: Readonly<Record<string, MachineFilter>> = {
  gives: (device) => device.gives.length > 0,
  takes: (device) => device.takes.length > 0,
  methods: (device) => device.methods.length > 0,
};

function PlaceOfStep({ field: { name, accepts }, label }: Shown) {
  const { step, set } = useStepEditor();
  return (
    <PlaceField
      label={label}
      field={name}
      places={!accepts}
      accept={accepts ? SUITS[accepts] : undefined}
      value={(step.params[name] ?? null) as Place | null}
      onChange={(place) => set(name, place)}
    />
  );
}
