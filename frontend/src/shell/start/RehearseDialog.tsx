/** Simulate with …: parameters, chance, how robots drive, and what goes wrong on purpose. */
import { Button, Modal, SegmentedControl } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { Dices, Plus, RotateCcw } from "lucide-react";
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { ApiProblem } from "@/api/client";
import { useOnce } from "@/api/once";
import { NumberField } from "@/design/NumberField";
import { useEditorText } from "@/program/canvas/useScene";
import { ownEntry } from "@/design/ownEntry";
import { problemText } from "../LoadProblem";
import { useTellUnseen } from "../refusal";
import {
  type Conditions,
  type Driver,
  DRIVERS,
  isSeed,
  keepConditions,
  keptConditions,
  LARGEST_SEED,
  USUAL,
} from "./conditions";
import { FaultCard } from "./FaultCard";
import { entryOf, freshFault, MOST_FAULTS, problemsOf } from "./faults";
import { Parameters } from "./Parameters";
import { stepChoices, type Startable } from "./startable";
import classes from "./start.module.css";

interface RehearseProps {
  about: Startable;
  /** The conditions to begin with; those that were kept in this browser where it is not said. */
  first?: Conditions;
  onClose: () => void;
  /** A rehearsal is queued. */
  onStarted: (rehearsal: string) => void;
}

export function RehearseDialog({ opened, onClose, ...form }: RehearseProps & { opened: boolean }) {
  const { t } = useTranslation();
  return (
    <Modal opened={opened} onClose={onClose} title={t("start.rehearse.title")} size={760}>
      <RehearseForm {...form} onClose={onClose} />
    </Modal>
  );
}

function useStart({ about, onStarted, onClose }: RehearseProps) {
  const begin = useOnce();
  const { program, version, stored } = about;
  return useMutation({
    mutationFn: async ({ faults, ...rest }: Conditions) => {
      await stored();
      return begin<{ id: string }>(`/programs/${program.id}/rehearsals`, {
        ...rest,
        ...(version === null ? {} : { version }),
        faults: { version: 1, faults: faults.map(entryOf) },
      });
    },
    onSuccess: ({ id }, conditions) => {
      keepConditions(program.id, conditions);
      onClose();
      onStarted(id);
    },
    onError: useTellUnseen(),
  });
}

/** What is wrong with what was filled in, field by field. */
function useProblems(about: Startable, conditions: Conditions) {
  const { t } = useTranslation();
  const around = { devices: about.devices, steps: new Set(about.compiled?.order) };
  const faults = conditions.faults.map((draft) => problemsOf(draft, around));
  const missing = Object.values(about.document.parameters).filter(
    ({ name, default: usual }) => (ownEntry(conditions.parameters, name) ?? usual ?? null) === null,
  );
  const parameters = Object.fromEntries(missing.map(({ name }) => [name, t("start.rehearse.needs_value")]));
  const seed = isSeed(conditions.seed) ? undefined : t("start.rehearse.seed_wrong", { most: LARGEST_SEED });
  const some = missing.length > 0 || seed !== undefined || faults.some((each) => Object.keys(each).length > 0);
  return { faults, parameters, seed, some };
}

function RehearseForm(props: RehearseProps) {
  const { t } = useTranslation();
  const { about, onClose } = props;
  const [conditions, setConditions] = useState(() => props.first ?? keptConditions(about.program.id));
  const [tried, setTried] = useState(false);
  const form = useRef<HTMLFormElement>(null);
  const set = (change: Partial<Conditions>) => {
    setConditions({ ...conditions, ...change });
    start.reset();
  };
  const start = useStart(props);
  const problems = useProblems(about, conditions);
  const shown = tried ? problems : { faults: [], parameters: {}, seed: undefined, some: false };
  const refused = start.error instanceof ApiProblem ? start.error : null;
  const parameters = Object.values(about.document.parameters);
  const submit = () => {
    setTried(true);
    if (problems.some)
      requestAnimationFrame(() => form.current?.querySelector<HTMLElement>("[aria-invalid=true]")?.focus());
    else
      start.mutate(
        knownParameters(
          conditions,
          parameters.map(({ name }) => name),
        ),
      );
  };
  return (
    <form
      ref={form}
      className={classes.content}
      noValidate
      onSubmit={(event) => {
        event.preventDefault();
        submit();
      }}
    >
      <p>{t("start.rehearse.intro")}</p>
      {parameters.length > 0 ? (
        <section className={classes.part} aria-label={t("start.rehearse.parameters")}>
          <h3>{t("start.rehearse.parameters")}</h3>
          <div className={classes.pair}>
            <Parameters
              {...about}
              parameters={parameters}
              given={conditions.parameters}
              errors={{ ...shown.parameters, ...parameterRefused(refused) }}
              onGive={(given) => set({ parameters: given })}
            />
          </div>
        </section>
      ) : null}
      <section className={classes.part} aria-label={t("start.rehearse.conditions")}>
        <h3>{t("start.rehearse.conditions")}</h3>
        <div className={classes.pair}>
          <DriverField driver={conditions.driver} onChange={(driver) => set({ driver })} />
          <SeedField seed={conditions.seed} error={shown.seed} onChange={(seed) => set({ seed })} />
        </div>
      </section>
      <Faults about={about} conditions={conditions} problems={shown.faults} refused={refused} set={set} />
      {refused && !placed(refused) ? (
        <p className={classes.problem} role="alert">
          {problemText(refused, refused.message)}
        </p>
      ) : null}
      {shown.some ? (
        <p className={classes.problem} role="alert">
          {t("start.rehearse.mend")}
        </p>
      ) : null}
      <div className={classes.buttons}>
        <Button
          variant="subtle"
          className={classes.left}
          leftSection={<RotateCcw size={15} aria-hidden="true" />}
          onClick={() => set(USUAL)}
        >
          {t("start.rehearse.usual")}
        </Button>
        <Button variant="default" onClick={onClose}>
          {t("editor.cancel")}
        </Button>
        <Button type="submit" data-autofocus loading={start.isPending}>
          {t("editor.simulate")}
        </Button>
      </div>
    </form>
  );
}

/** Parameters that the program has no longer are not sent. */
function knownParameters(conditions: Conditions, names: readonly string[]): Conditions {
  const known = Object.entries(conditions.parameters).filter(([name, value]) => names.includes(name) && value !== null);
  return { ...conditions, parameters: Object.fromEntries(known) };
}

/** The number of the fault that was refused, from 1; 0: none. */
function faultRefused(refused: ApiProblem | null): number {
  return refused?.code === "bad_faults" && typeof refused.args.number === "number" ? refused.args.number : 0;
}

function parameterRefused(refused: ApiProblem | null): Readonly<Record<string, string>> {
  const { why, name } = refused?.args ?? {};
  const known = typeof why === "string" && why.startsWith("parameter") && typeof name === "string";
  return known && refused ? { [name]: refused.detail } : {};
}

/** Whether a refusal stands at the field that it is about. */
function placed(refused: ApiProblem): boolean {
  return faultRefused(refused) > 0 || Object.keys(parameterRefused(refused)).length > 0;
}

function DriverField({ driver, onChange }: { driver: Driver; onChange: (driver: Driver) => void }) {
  const { t } = useTranslation();
  return (
    <div className={classes.labelled}>
      <span id="rehearse-driver">{t("start.rehearse.driver")}</span>
      <SegmentedControl
        fullWidth
        aria-labelledby="rehearse-driver"
        aria-describedby="rehearse-driver-about"
        data={DRIVERS.map((value) => ({ value, label: t(`start.rehearse.drivers.${value}.name`) }))}
        value={driver}
        onChange={onChange}
      />
      <small id="rehearse-driver-about">{t(`start.rehearse.drivers.${driver}.about`)}</small>
    </div>
  );
}

interface SeedProps {
  seed: number;
  error: string | undefined;
  onChange: (seed: number) => void;
}

function SeedField({ seed, error, onChange }: SeedProps) {
  const { t } = useTranslation();
  return (
    <div className={classes.seed}>
      <NumberField
        label={t("start.rehearse.seed")}
        description={t("start.rehearse.seed_about")}
        inputWrapperOrder={["label", "input", "description", "error"]}
        allowDecimal={false}
        value={Number.isNaN(seed) ? "" : seed}
        error={error}
        onChange={(next) => onChange(typeof next === "number" ? next : NaN)}
      />
      <Button
        variant="default"
        leftSection={<Dices size={16} aria-hidden="true" />}
        onClick={() => onChange(1 + Math.floor(Math.random() * 9999))}
      >
        {t("start.rehearse.another_seed")}
      </Button>
    </div>
  );
}

interface FaultsProps {
  about: Startable;
  conditions: Conditions;
  problems: readonly ReturnType<typeof problemsOf>[];
  refused: ApiProblem | null;
  set: (change: Partial<Conditions>) => void;
}

function Faults({ about, conditions: { faults }, problems, refused, set }: FaultsProps) {
  const { t } = useTranslation();
  const say = useEditorText();
  const steps = stepChoices(about, say);
  return (
    <section className={classes.part} aria-label={t("start.fault.title")}>
      <h3>{t("start.fault.title")}</h3>
      <p>{t(faults.length === 0 ? "start.fault.none" : "start.fault.only_here")}</p>
      {faults.map((draft, at) => (
        <FaultCard
          key={draft.key}
          draft={draft}
          number={at + 1}
          devices={about.devices}
          steps={steps}
          problems={problems[at] ?? {}}
          {...(refused && faultRefused(refused) === at + 1 ? { refusal: refused.detail } : {})}
          onChange={(changed) => set({ faults: faults.map((each, place) => (place === at ? changed : each)) })}
          onRemove={() => set({ faults: faults.filter((_, place) => place !== at) })}
        />
      ))}
      <Button
        variant="default"
        className={classes.add}
        leftSection={<Plus size={16} aria-hidden="true" />}
        disabled={faults.length >= MOST_FAULTS}
        onClick={() => set({ faults: [...faults, freshFault()] })}
      >
        {t("start.fault.add")}
      </Button>
    </section>
  );
}
