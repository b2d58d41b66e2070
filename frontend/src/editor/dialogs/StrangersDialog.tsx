/** Steps from another site name devices that are not here: a list asks who stands in, the best match already chosen. */
import { Button, Modal, Select } from "@mantine/core";
import { CircleCheck, TriangleAlert } from "lucide-react";
import type { TFunction } from "i18next";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { canAll, matchesFor, type Needs, type Stranger } from "../edits/holes";
import { useOpenProgram, type OpenProgram } from "../state/context";
import { answerWaiting, useWaiting } from "../state/putting";
import { useUi } from "../state/ui";
import classes from "./dialogs.module.css";

/** No device has an id with a colon. */
const OPEN = ":open";

export function StrangersDialog() {
  const { t } = useTranslation();
  const opened = useUi((ui) => ui.dialog === "strangers");
  const waiting = useWaiting((state) => state.waiting);
  return (
    <Modal opened={opened && waiting !== null} onClose={leave} title={t("commands.strangers.title")} size={560}>
      {waiting ? <Content strangers={waiting.strangers} /> : null}
    </Modal>
  );
}

function leave(): void {
  answerWaiting(null);
}

function Content({ strangers }: { strangers: readonly Stranger[] }) {
  const open = useOpenProgram();
  const { t } = useTranslation();
  const [chosen, setChosen] = useState(() => new Map(strangers.map((each) => [each.id, firstMatch(open, each)])));
  return (
    <div className={classes.content}>
      <p>{t("commands.strangers.text")}</p>
      {strangers.map((stranger) => (
        <Choice
          key={stranger.id}
          stranger={stranger}
          value={chosen.get(stranger.id) ?? null}
          onChoose={(id) => setChosen(new Map(chosen).set(stranger.id, id))}
        />
      ))}
      <div className={classes.buttons}>
        <Button variant="default" onClick={leave}>
          {t("commands.strangers.cancel")}
        </Button>
        <Button onClick={() => answerWaiting(chosen)} data-autofocus>
          {t("commands.strangers.insert")}
        </Button>
      </div>
    </div>
  );
}

/** Only what can do all of it is chosen without being asked. */
function firstMatch({ devices, plan }: OpenProgram, stranger: Stranger): string | null {
  if (stranger.kind === "place") return plan?.places.find(({ name }) => name === stranger.name)?.id ?? null;
  const [first] = matchesFor(stranger, devices);
  return first && canAll(first, stranger.needs) ? first.id : null;
}

interface ChoiceProps {
  stranger: Stranger;
  value: string | null;
  onChoose: (id: string | null) => void;
}

function Choice({ stranger, value, onChoose }: ChoiceProps) {
  const { devices, plan } = useOpenProgram();
  const { t } = useTranslation();
  const options: { id: string; name: string }[] =
    stranger.kind === "device" ? matchesFor(stranger, devices) : [...(plan?.places ?? [])];
  const device = devices.find(({ id }) => id === value);
  return (
    <div className={classes.stranger}>
      <Select
        label={stranger.name}
        description={needsInWords(stranger.needs, t) || undefined}
        data={[
          { value: OPEN, label: t("commands.strangers.open") },
          ...options.map(({ id, name }) => ({ value: id, label: name })),
        ]}
        value={value ?? OPEN}
        allowDeselect={false}
        searchable
        onChange={(next) => onChoose(next === OPEN ? null : next)}
      />
      {device ? <Fit suits={canAll(device, stranger.needs)} /> : null}
    </div>
  );
}

function Fit({ suits }: { suits: boolean }) {
  const { t } = useTranslation();
  return (
    <span className={classes.fit} data-tone={suits ? "done" : "warn"}>
      {suits ? <CircleCheck size={15} aria-hidden="true" /> : <TriangleAlert size={15} aria-hidden="true" />}
      {t(suits ? "commands.strangers.suits" : "commands.strangers.lacks")}
    </span>
  );
}

function needsInWords(needs: Needs, t: TFunction): string {
  const lists = (["methods", "gives", "takes", "readings"] as const).filter((each) => needs[each].length > 0);
  const said = lists.map((each) => t(`commands.strangers.needs_${each}`, { list: needs[each].join(", ") }));
  return [needs.robot ? t("commands.strangers.robot") : "", ...said].filter(Boolean).join("; ");
}
