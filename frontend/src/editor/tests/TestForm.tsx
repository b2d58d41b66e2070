/** A test as sentences and fields: what is given, what happens, what goes wrong on purpose, and what then holds. */
import { Button, Menu, Select, TextInput } from "@mantine/core";
import { Plus } from "lucide-react";
import { type ReactNode, useId, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import type { TestResult } from "@/api/types";
import { NumberField } from "@/design/NumberField";
import { useEditorText } from "@/program/canvas/useScene";
import { DRIVERS, LARGEST_SEED } from "@/shell/start/conditions";
import { FaultCard } from "@/shell/start/FaultCard";
import { freshFault, MOST_FAULTS, problemsOf } from "@/shell/start/faults";
import { Parameters } from "@/shell/start/Parameters";
import { stepChoices } from "@/shell/start/startable";
import { useStartable } from "../dialogs/startable";
import { GivenLine } from "./GivenLine";
import { ThenLine } from "./ThenLine";
import { type FaultRow, freshGiven, freshThen, isWhole, rowsOf, type TestRows, THEN, valuesOf } from "./testRows";
import { GIVEN, readValues, type TestValues, writeValues } from "./testText";
import { keepForm, useTestsUi } from "./tests";
import classes from "./testForm.module.css";

interface TestFormProps {
  /** The id of the test, or `new`. */
  opened: string;
  text: string;
  readOnly: boolean;
  /** What came of the test as it is written here. */
  result: TestResult | null;
  onType: (text: string) => void;
  onText: () => void;
}

export function TestForm({ opened, text, readOnly, result, onType, onText }: TestFormProps) {
  const { t } = useTranslation();
  const form = useForm(opened, text, onType);
  if (!form)
    return (
      <div className={classes.unread}>
        <p>{t("tests.form.unread")}</p>
        <Button size="compact-sm" variant="default" onClick={onText}>
          {t("tests.form.to_text")}
        </Button>
      </div>
    );
  return (
    <fieldset className={classes.form} disabled={readOnly} aria-label={t("tests.form.label")}>
      <TextInput
        size="xs"
        label={t("tests.form.name")}
        value={form.values.name}
        maxLength={200}
        onChange={(event) => form.set({ name: event.currentTarget.value })}
      />
      <GivenPart {...form} />
      <WhenPart {...form} />
      <FaultsPart {...form} />
      <ThenPart {...form} result={result} />
    </fieldset>
  );
}

interface FormProps {
  values: TestValues;
  rows: TestRows;
  about: ReturnType<typeof useStartable>;
  set: (change: Partial<TestValues>) => void;
  setRows: (rows: TestRows) => void;
}

/** The form of a text, kept while its own changes come back as the text; null where no form can show it. */
function useForm(opened: string, text: string, onType: (text: string) => void): FormProps | null {
  const about = useStartable();
  const { compiled, document, devices } = about;
  const steps = useMemo(() => new Set(Object.keys(document.steps)), [document]);
  const stepNamed = (said: string) => {
    if (steps.has(said)) return said;
    return Object.entries(compiled?.numbers ?? {}).find(([, number]) => number === said)?.[0] ?? null;
  };
  const read = () => {
    const values = readValues(text);
    return { text, values, rows: values && rowsOf(values, stepNamed) };
  };
  const filled = useTestsUi((ui) => ui.forms[opened]);
  const [known, setKnown] = useState(read);
  // What was written elsewhere, in the text or by somebody else, is read anew.
  const now = [filled, known].find((each) => each?.text === text) ?? read();
  if (now !== filled && now !== known) setKnown(now);
  const { values, rows } = now;
  if (!values || !rows) return null;
  const write = (change: Partial<TestValues>, next: TestRows) => {
    const written = writeValues(text, change);
    keepForm(opened, { text: written, values: { ...values, ...change }, rows: next });
    if (written !== text) onType(written);
  };
  return {
    values,
    rows,
    about,
    set: (change) => write(change, rows),
    setRows: (next) => {
      const { given, faults, then } = valuesOf(next, { devices, steps });
      write(
        {
          ...(next.given === rows.given ? {} : { given }),
          ...(next.faults === rows.faults ? {} : { faults }),
          ...(next.then === rows.then ? {} : { then }),
        },
        next,
      );
    },
  };
}

function Part({ title, children }: { title: string; children: ReactNode }) {
  const id = useId();
  return (
    <section className={classes.part} aria-labelledby={id}>
      <h3 id={id}>{title}</h3>
      <div className={classes.lines}>{children}</div>
    </section>
  );
}

interface AddProps<Kind extends string> {
  label: string;
  kinds: readonly Kind[];
  words: (kind: Kind) => string;
  onAdd: (kind: Kind) => void;
}

function AddLine<Kind extends string>({ label, kinds, words, onAdd }: AddProps<Kind>) {
  return (
    <Menu position="bottom-start">
      <Menu.Target>
        <Button size="compact-xs" variant="subtle" className={classes.add} leftSection={<Plus size={13} aria-hidden />}>
          {label}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {kinds.map((kind) => (
          <Menu.Item key={kind} onClick={() => onAdd(kind)}>
            {words(kind)}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

/** The lines with one of them changed, or without it. */
function withLine<Line>(lines: readonly Line[], at: number, line: Line | null): readonly Line[] {
  return lines.flatMap((each, place) => (place === at ? (line === null ? [] : [line]) : [each]));
}

function GivenPart({ rows, setRows, about }: FormProps) {
  const { t } = useTranslation();
  const set = (given: TestRows["given"]) => setRows({ ...rows, given });
  return (
    <Part title={t("tests.form.given")}>
      {rows.given.length === 0 ? <p className={classes.note}>{t("tests.form.given_none")}</p> : null}
      <ul>
        {rows.given.map((row, at) => (
          <GivenLine
            key={row.key}
            row={row}
            number={at + 1}
            devices={about.devices}
            onChange={(changed) => set(withLine(rows.given, at, changed))}
            onRemove={() => set(withLine(rows.given, at, null))}
          />
        ))}
      </ul>
      <AddLine
        label={t("tests.form.add_given")}
        kinds={GIVEN}
        words={(kind) => t(`tests.form.given_kind.${kind}`)}
        onAdd={(kind) => set([...rows.given, freshGiven(kind)])}
      />
    </Part>
  );
}

function WhenPart({ values, set, about }: FormProps) {
  const { t } = useTranslation();
  const parameters = Object.values(about.document.parameters);
  return (
    <Part title={t("tests.form.when")}>
      <div className={classes.fields}>
        {parameters.length > 0 ? (
          <Parameters
            {...about}
            parameters={parameters}
            given={values.parameters}
            onGive={(given) => {
              const said = Object.entries(given).filter(([, value]) => value !== null);
              set({ parameters: Object.fromEntries(said) as TestValues["parameters"] });
            }}
          />
        ) : null}
        <NumberField
          size="xs"
          label={t("start.rehearse.seed")}
          placeholder="0"
          min={0}
          max={LARGEST_SEED}
          allowDecimal={false}
          value={values.seed ?? ""}
          onChange={(next) => set({ seed: typeof next === "number" ? next : null })}
        />
        <Select
          size="xs"
          label={t("start.rehearse.driver")}
          data={DRIVERS.map((value) => ({ value, label: t(`start.rehearse.drivers.${value}.name`) }))}
          value={values.driver ?? "kinematic"}
          allowDeselect={false}
          onChange={(driver) => set({ driver })}
        />
        <NumberField
          size="xs"
          label={t("tests.form.limit")}
          placeholder={t("tests.form.limit_usual")}
          min={1}
          suffix=" s"
          value={values.limit_s ?? ""}
          onChange={(next) => set({ limit_s: typeof next === "number" ? next : null })}
        />
      </div>
    </Part>
  );
}

function useSteps({ document, compiled, devices, places }: FormProps["about"]) {
  const say = useEditorText();
  return useMemo(
    () => stepChoices({ document, compiled, devices, places }, say),
    [document, compiled, devices, places, say],
  );
}

function FaultsPart({ rows, setRows, about }: FormProps) {
  const { t } = useTranslation();
  const steps = useSteps(about);
  const around = { devices: about.devices, steps: new Set(Object.keys(about.document.steps)) };
  const set = (faults: readonly FaultRow[]) => setRows({ ...rows, faults });
  return (
    <Part title={t("tests.form.faults")}>
      {rows.faults.length === 0 ? <p className={classes.note}>{t("tests.form.faults_none")}</p> : null}
      {rows.faults.map(({ draft, isTouched, written }, at) =>
        draft ? (
          <FaultCard
            key={draft.key}
            draft={draft}
            number={at + 1}
            devices={about.devices}
            steps={steps}
            problems={isTouched ? problemsOf(draft, around) : {}}
            onChange={(changed) => set(withLine(rows.faults, at, { draft: changed, isTouched: true, written: null }))}
            onRemove={() => set(withLine(rows.faults, at, null))}
          />
        ) : (
          <p key={at} className={classes.note}>
            {t("tests.form.only_text", { text: JSON.stringify(written) })}
          </p>
        ),
      )}
      <Button
        size="compact-xs"
        variant="subtle"
        className={classes.add}
        leftSection={<Plus size={13} aria-hidden="true" />}
        disabled={rows.faults.length >= MOST_FAULTS}
        onClick={() => set([...rows.faults, { draft: freshFault(), isTouched: false, written: null }])}
      >
        {t("start.fault.add")}
      </Button>
    </Part>
  );
}

function ThenPart({ rows, setRows, about, result }: FormProps & { result: TestResult | null }) {
  const { t } = useTranslation();
  const steps = useSteps(about);
  const set = (then: TestRows["then"]) => setRows({ ...rows, then });
  const written = rows.then.filter(isWhole.then);
  const seen = result?.expectations.length === written.length ? result.expectations : [];
  return (
    <Part title={t("tests.form.then")}>
      <ul>
        {rows.then.map((row, at) => (
          <ThenLine
            key={row.key}
            row={row}
            number={at + 1}
            about={about}
            steps={steps}
            holds={seen[written.indexOf(row)]?.ok ?? null}
            onChange={(changed) => set(withLine(rows.then, at, changed))}
            onRemove={rows.then.length > 1 ? () => set(withLine(rows.then, at, null)) : null}
          />
        ))}
      </ul>
      <AddLine
        label={t("tests.form.add_then")}
        kinds={THEN}
        words={(kind) => t(`tests.form.then_kind.${kind}`)}
        onAdd={(kind) => set([...rows.then, freshThen(kind)])}
      />
    </Part>
  );
}
