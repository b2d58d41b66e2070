/** Find what this program names, and the steps that use it. */
import { Button, Modal, TextInput } from "@mantine/core";
import { Cpu, MapPin, Search, SquareFunction, Variable, VectorSquare } from "lucide-react";
import { type ComponentType, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { chipLabel } from "@/program/scene/announcements";
import { wordsOf } from "@/shell/palette/search";
import { showSteps } from "../commands/view";
import { sortByReading } from "../edits/clipping";
import { type UsedKind, usesOf, variablesOf } from "../edits/uses";
import { useOpenProgram, type OpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import classes from "./dialogs.module.css";

const KINDS = ["device", "place", "zone", "variable", "function"] as const;
const SIGNS: Readonly<Record<UsedKind, ComponentType<{ size?: number }>>> = {
  device: Cpu,
  place: MapPin,
  zone: VectorSquare,
  variable: Variable,
  function: SquareFunction,
};
const MOST_STEPS = 30;

export function FindDialog() {
  const { t } = useTranslation();
  const opened = useUi((ui) => ui.dialog === "find");
  return (
    <Modal opened={opened} onClose={close} title={t("commands.find_in.title")} size={560}>
      {opened ? <Content /> : null}
    </Modal>
  );
}

function close(): void {
  useUi.setState({ dialog: null });
}

interface Found {
  readonly kind: UsedKind;
  readonly id: string;
  readonly name: string;
  /** In reading order. */
  readonly steps: readonly string[];
}

function Content() {
  const open = useOpenProgram();
  const { t } = useTranslation();
  const begin = useUi((ui) => ui.find);
  const [text, setText] = useState(() => open.surroundings.devices.get(begin)?.name ?? "");
  const all = useMemo(() => namedThings(open), [open]);
  const words = wordsOf(text);
  const fits = (own: string) => words.every((word) => wordsOf(own).some((each) => each.includes(word)));
  const found = all.filter(({ name, id }) => fits(`${name} ${id}`));
  const steps = words.length === 0 ? [] : stepsWith(open, fits);
  return (
    <div className={classes.content}>
      <TextInput
        aria-label={t("commands.find_in.label")}
        placeholder={t("commands.find_in.label")}
        leftSection={<Search size={16} aria-hidden="true" />}
        value={text}
        data-autofocus
        onChange={(event) => setText(event.currentTarget.value)}
      />
      {KINDS.map((kind) => (
        <Things key={kind} kind={kind} found={found.filter((each) => each.kind === kind)} single={found.length === 1} />
      ))}
      {steps.length > 0 ? (
        <section aria-label={t("commands.find_in.steps")}>
          <h3 className={classes.keysTitle}>{t("commands.find_in.steps")}</h3>
          <Steps steps={steps} />
        </section>
      ) : null}
      {found.length + steps.length === 0 ? <p>{t("commands.find_in.none")}</p> : null}
    </div>
  );
}

/** What is used comes first. */
function namedThings({ document, devices, plan, scene }: OpenProgram): Found[] {
  const thing = (kind: UsedKind, id: string, name: string): Found => {
    return { kind, id, name, steps: sortByReading(scene.tree, usesOf(document, { kind, id })) };
  };
  const all = [
    ...devices.map(({ id, name }) => thing("device", id, name)),
    ...(plan?.places ?? []).map(({ id, name }) => thing("place", id, name)),
    ...Object.entries(document.zones).map(([id, { name }]) => thing("zone", id, name)),
    ...variablesOf(document).map((name) => thing("variable", name, name)),
    ...Object.entries(document.functions).map(([id, { name }]) => thing("function", id, name)),
  ];
  return all.sort((one, other) => Number(other.steps.length > 0) - Number(one.steps.length > 0));
}

function stepsWith({ scene, speaker }: OpenProgram, fits: (text: string) => boolean): readonly string[] {
  const chips = [...scene.chips.values()].filter((chip) => fits(chipLabel(chip, speaker)));
  return sortByReading(
    scene.tree,
    chips.map((chip) => chip.id),
  ).slice(0, MOST_STEPS);
}

function Things({ kind, found, single }: { kind: UsedKind; found: readonly Found[]; single: boolean }) {
  const { t } = useTranslation();
  if (found.length === 0) return null;
  return (
    <section aria-label={t(`commands.find_in.${kind}`)}>
      <h3 className={classes.keysTitle}>{t(`commands.find_in.${kind}`)}</h3>
      <ul className={classes.keys}>
        {found.map((each) => (
          <Thing key={each.id} found={each} begin={single} />
        ))}
      </ul>
    </section>
  );
}

/** One thing; pressed, it lists its steps. */
function Thing({ found, begin }: { found: Found; begin: boolean }) {
  const open = useOpenProgram();
  const { t } = useTranslation();
  const [opened, setOpened] = useState(begin);
  const { kind, name, steps } = found;
  const Sign = SIGNS[kind];
  const selectAll = () => {
    select(steps);
    showSteps(open, steps);
    close();
  };
  return (
    <li>
      <button
        type="button"
        className={classes.thing}
        aria-expanded={steps.length > 0 ? opened : undefined}
        disabled={steps.length === 0}
        onClick={() => setOpened(!opened)}
      >
        <Sign size={16} aria-hidden="true" />
        <span>{name}</span>
        <small>
          {steps.length > 0 ? t("commands.find_in.used", { count: steps.length }) : t("commands.find_in.unused")}
        </small>
      </button>
      {opened && steps.length > 0 ? (
        <>
          <Steps steps={steps} />
          {steps.length > 1 ? (
            <Button variant="subtle" size="compact-sm" onClick={selectAll}>
              {t("commands.find_in.select_all")}
            </Button>
          ) : null}
        </>
      ) : null}
    </li>
  );
}

function Steps({ steps }: { steps: readonly string[] }) {
  const open = useOpenProgram();
  const go = (id: string) => {
    select([id]);
    showSteps(open, [id]);
    close();
  };
  return (
    <ul className={classes.foundSteps}>
      {steps.map((id) => {
        const chip = open.scene.chips.get(id);
        return chip ? (
          <li key={id}>
            <button type="button" onClick={() => go(id)}>
              {chipLabel(chip, open.speaker)}
            </button>
          </li>
        ) : null;
      })}
    </ul>
  );
}
