/** One fault on purpose: what goes wrong, with which device, when, and what else its kind needs. */
import { Select, TextInput } from "@mantine/core";
import { Trash2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { Device } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { NumberField } from "@/design/NumberField";
import { unitSign } from "@/i18n/units";
import {
  beginningsOf,
  devicesFor,
  FAULT_WORDS,
  type FaultDraft,
  type FaultProblems,
  type FaultWord,
  lasts,
  propertyOf,
  wordsOf,
} from "./faults";
import { ScalarInput } from "./ScalarInput";
import type { Choice } from "./startable";
import classes from "./start.module.css";

interface FaultCardProps {
  draft: FaultDraft;
  number: number;
  devices: readonly Device[];
  steps: readonly Choice[];
  /** What is wrong with its fields; empty while nobody has tried to begin. */
  problems: FaultProblems;
  /** Why the server has refused it. */
  refusal?: string;
  onChange: (draft: FaultDraft) => void;
  onRemove: () => void;
}

export function FaultCard(props: FaultCardProps) {
  const { t } = useTranslation();
  const { draft, number, problems, refusal } = props;
  const wrongDevice = useProblem(problems.device);
  const set = (change: Partial<FaultDraft>) => props.onChange({ ...draft, ...change });
  return (
    <fieldset className={classes.fault} data-wrong={refusal !== undefined || Object.keys(problems).length > 0}>
      <legend className="visually-hidden">{t("start.fault.number", { number })}</legend>
      <div className={classes.faultHead}>
        <Select
          label={t("start.fault.what")}
          data={FAULT_WORDS.map((word) => ({ value: word, label: t(`start.fault.kind.${word}.name`) }))}
          value={draft.fault}
          allowDeselect={false}
          onChange={(word) => set(kindChosen(draft, word as FaultWord, props.devices))}
        />
        {draft.fault === "obstacle" ? null : (
          <Select
            label={t("start.fault.device")}
            data={devicesFor(draft.fault, props.devices).map(({ id, name }) => ({ value: id, label: name }))}
            value={draft.device}
            placeholder={t("editor.field.choose")}
            searchable
            error={wrongDevice}
            onChange={(device) => set({ device, property: null, value: null })}
          />
        )}
        <IconButton label={t("start.fault.remove", { number })} onClick={props.onRemove}>
          <Trash2 size={16} aria-hidden="true" />
        </IconButton>
      </div>
      <p className={classes.about}>{t(`start.fault.kind.${draft.fault}.about`)}</p>
      <div className={classes.faultFields}>
        <Details {...props} set={set} />
        <Begins {...props} set={set} />
        {lasts(draft.fault) ? (
          <FaultNumber {...props} set={set} name="for_s" placeholder={t("start.fault.to_the_end")} />
        ) : null}
      </div>
      {refusal === undefined ? null : (
        <p className={classes.problem} role="alert">
          {refusal}
        </p>
      )}
    </fieldset>
  );
}

/** Another kind keeps what it can have, too. */
function kindChosen(draft: FaultDraft, fault: FaultWord, devices: readonly Device[]): Partial<FaultDraft> {
  const stays = devicesFor(fault, devices).some(({ id }) => id === draft.device);
  const begins = beginningsOf(fault).includes(draft.begins) ? draft.begins : "now";
  return { fault, begins, ...(stays ? {} : { device: null, property: null, value: null }) };
}

interface PartProps extends FaultCardProps {
  set: (change: Partial<FaultDraft>) => void;
}

function useProblem(problem: FaultProblems[string] | undefined): string | undefined {
  const { t } = useTranslation();
  return problem && t(`start.fault.problem.${problem.why}`, { least: problem.least, most: problem.most });
}

interface FaultNumberProps extends PartProps {
  name: keyof FaultDraft["numbers"];
  placeholder?: string;
}

function FaultNumber({ draft, set, name, problems, placeholder }: FaultNumberProps) {
  const { t } = useTranslation();
  const { numbers } = draft;
  const scale = name === "odds" ? 100 : 1;
  const value = numbers[name];
  return (
    <NumberField
      label={t(`start.fault.field.${name}`)}
      placeholder={placeholder}
      value={value === undefined ? "" : Math.round(value * scale * 1e6) / 1e6}
      error={useProblem(problems[name])}
      onChange={(next) => set({ numbers: { ...numbers, [name]: typeof next === "number" ? next / scale : undefined } })}
    />
  );
}

function Begins(props: PartProps) {
  const { t } = useTranslation();
  const { draft, set, steps, problems } = props;
  const problem = useProblem(problems.at_step);
  return (
    <>
      <Select
        label={t("start.fault.begins")}
        data={beginningsOf(draft.fault).map((value) => ({ value, label: t(`start.fault.beginning.${value}`) }))}
        value={draft.begins}
        allowDeselect={false}
        onChange={(begins) => set({ begins: begins as FaultDraft["begins"] })}
      />
      {draft.begins === "at" ? <FaultNumber {...props} name="at_s" /> : null}
      {draft.begins === "chance" ? <FaultNumber {...props} name="odds" /> : null}
      {draft.begins === "step" ? (
        <>
          <Select
            label={t("start.fault.at_step")}
            data={[...steps]}
            value={draft.at_step}
            placeholder={t("editor.field.choose")}
            searchable
            error={problem}
            onChange={(step) => set({ at_step: step })}
          />
          <FaultNumber {...props} name="nth" />
        </>
      ) : null}
    </>
  );
}

function Details(props: PartProps) {
  const { t } = useTranslation();
  const { draft, set } = props;
  const words = wordsOf(draft.fault);
  return (
    <>
      {(["after_s", "percent", "x", "y", "size_m"] as const)
        .filter((name) => words.includes(name))
        .map((name) => (
          <FaultNumber key={name} {...props} name={name} />
        ))}
      {words.includes("error") ? (
        <TextInput
          label={t("start.fault.field.error")}
          maxLength={200}
          value={draft.error}
          onChange={(event) => set({ error: event.currentTarget.value })}
        />
      ) : null}
      {words.includes("property") ? <Reading {...props} /> : null}
    </>
  );
}

/** Which reading is wrong, and what it shows. */
function Reading(props: PartProps) {
  const { t } = useTranslation();
  const { draft, set, devices, problems } = props;
  const device = devices.find(({ id }) => id === draft.device);
  const property = propertyOf(draft, devices);
  const [wrongProperty, wrongValue] = [useProblem(problems.property), useProblem(problems.value)];
  const unit = unitSign(property?.unit);
  const label = unit ? `${t("start.fault.field.value")} (${unit})` : t("start.fault.field.value");
  return (
    <>
      <Select
        label={t("start.fault.field.property")}
        data={(device?.properties ?? []).map(({ name }) => name)}
        value={draft.property}
        placeholder={t("editor.field.choose")}
        disabled={!device}
        error={wrongProperty}
        onChange={(name) => set({ property: name, value: null })}
      />
      <ScalarInput
        type={property?.type ?? ""}
        label={label}
        disabled={!property}
        value={draft.value}
        error={wrongValue}
        onChange={(value) => set({ value })}
      />
    </>
  );
}
