/** The program as a list: everything that the map shows, by keyboard. */
import { OctagonAlert, TriangleAlert } from "lucide-react";
import { useRef, type KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import { Avatar } from "@/design/Avatar";
import { VipoIcon } from "@/design/VipoIcon";
import { chipLabel, detailOf } from "@/program/scene/announcements";
import type { Chip } from "@/program/scene/chips";
import { branchWord } from "@/program/scene/links";
import { placeName } from "@/program/words/stepWords";
import type { Place } from "@/program/document/document";
import { announce } from "../keyboard/announcer";
import { beside } from "../keyboard/goals";
import { useOpenProgram } from "../state/context";
import { shiftInOrder } from "../state/actions";
import type { Person } from "../state/presence";
import { setsDownByEnter } from "../state/tool";
import { select, toggleSelected, useUi } from "../state/ui";
import classes from "./drawer.module.css";

export function StepTree() {
  const open = useOpenProgram();
  const { scene, t } = open;
  const selected = useUi((ui) => ui.selected);
  const list = useRef<HTMLUListElement>(null);
  const { t: words } = useTranslation();
  const comments = [...scene.chips.values()].filter((chip) => chip.kind === "comment").map((chip) => chip.id);
  const rows = [...scene.tree.reading, ...scene.tree.loose, ...comments].flatMap((id) => scene.chips.get(id) ?? []);
  const current = selected.at(-1) ?? rows[0]?.id;
  const go = (id: string | undefined) => {
    if (!id) return;
    select([id]);
    list.current?.querySelector<HTMLElement>(`[data-step="${CSS.escape(id)}"]`)?.focus();
  };
  /** At its ends the list stops, and says so. */
  const walk = (from: number, by: number) => {
    const to = beside(from, by, rows.length);
    if (to === from) announce(words(by > 0 ? "access.outline.last" : "access.outline.first"));
    else go(rows[to]?.id);
  };
  const press = (event: KeyboardEvent, chip: Chip, index: number) => {
    if (event.altKey && event.shiftKey && (event.key === "ArrowUp" || event.key === "ArrowDown"))
      shiftInOrder(open, chip.id, event.key === "ArrowUp" ? -1 : 1);
    else if (event.key in LISTED) walk(index, LISTED[event.key] ?? 0);
    else if (event.key === "Enter" && open.canEdit && setsDownByEnter(useUi.getState().gesture)) return;
    else if (event.key === "Enter" || event.key === " ") select([chip.id]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  if (rows.length === 0) return <p className={classes.nothing}>{t("steps.none")}</p>;
  return (
    <ul className={classes.steps} role="tree" aria-label={t("drawer.steps")} aria-multiselectable ref={list}>
      {rows.map((chip, index) => (
        <StepRow
          key={chip.id}
          chip={chip}
          current={chip.id === current}
          onPress={(event) => press(event, chip, index)}
        />
      ))}
    </ul>
  );
}

const LISTED: Readonly<Record<string, number>> = { ArrowDown: 1, ArrowUp: -1, Home: -Infinity, End: Infinity };

function StepRow({
  chip,
  current,
  onPress,
}: {
  chip: Chip;
  current: boolean;
  onPress: (event: KeyboardEvent) => void;
}) {
  const { scene, speaker, t, people } = useOpenProgram();
  const { t: words } = useTranslation();
  const selected = useUi((ui) => ui.selected);
  const here = people.filter((each) => !each.me && (each.selection.includes(chip.id) || each.editing === chip.id));
  const label = [
    chipLabel(chip, speaker),
    chip.draft ? t("steps.draft") : "",
    here.length > 0 ? words("access.outline.people", { names: here.map(({ name }) => name).join(", ") }) : "",
  ];
  return (
    <li
      data-step={chip.id}
      className={classes.step}
      role="treeitem"
      aria-level={scene.tree.depth(chip.id) + 1}
      aria-selected={selected.includes(chip.id)}
      aria-label={label.filter(Boolean).join(", ")}
      tabIndex={current ? 0 : -1}
      style={{ paddingLeft: 8 + scene.tree.depth(chip.id) * 22 }}
      onClick={(event) => (event.shiftKey ? toggleSelected(chip.id) : select([chip.id]))}
      onKeyDown={onPress}
    >
      {/* The label says all of it, in the words of who listens. */}
      <RowBody chip={chip} here={here} />
    </li>
  );
}

function RowBody({ chip, here }: { chip: Chip; here: readonly Person[] }) {
  const { t } = useOpenProgram();
  const { t: words } = useTranslation();
  return (
    <span aria-hidden="true" className={classes.row}>
      <span className={classes.number}>{chip.number || "–"}</span>{" "}
      <span style={{ color: `var(--${chip.family})`, display: "inline-flex" }}>
        <VipoIcon name={chip.icon} size={16} />
      </span>
      <BranchName step={chip.id} />
      <span>
        {t(`kind.${chip.kind}`)}
        {detailOf(chip).length > 0 ? ": " : " "}
        {detailOf(chip).map((part, at) => (
          <span key={at} className={part.tone === "missing" ? classes.missing : undefined}>
            {`${part.text} `}
          </span>
        ))}
        <Where step={chip.id} />
      </span>
      {chip.draft ? <Beside words={t("steps.draft")} /> : null}
      {chip.problem ? (
        <span className={classes.found} data-tone={chip.problem}>
          {chip.problem === "error" ? <OctagonAlert size={14} /> : <TriangleAlert size={14} />}
          <Beside
            bare
            words={
              chip.errors > 0 ? words("access.outline.errors", { count: chip.errors }) : t(`announce.${chip.problem}`)
            }
          />
        </span>
      ) : null}
      {here.map((each) => (
        <Avatar key={each.client} name={each.name} initials={each.initials} colour={each.colour} size={18} />
      ))}
    </span>
  );
}

/** Words beside the step's own: drawn, not written, since who speaks to the screen names the row by what it is. */
function Beside({ words, bare = false }: { words: string; bare?: boolean }) {
  return <span className={bare ? classes.drawn : `${classes.branch} ${classes.drawn}`} data-words={words} />;
}

/** The word of its arrow, or the function whose own step it is. */
function BranchName({ step }: { step: string }) {
  const { document, t } = useOpenProgram();
  const place = document.steps[step]?.place;
  if (!place) return null;
  const parent = document.steps[place[0]];
  const word = parent && place[1] !== "body" ? branchWord(place[1], parent, t) : document.functions[place[0]]?.name;
  return word ? <Beside words={word} /> : null;
}

function Where({ step: id }: { step: string }) {
  const { document, speaker, t } = useOpenProgram();
  const step = document.steps[id];
  const name = (field: string) => placeName(step?.params[field] as Place, speaker) ?? "?";
  if (step?.kind === "pick_and_drop")
    return <>{t("announce.from_to", { source: name("source"), target: name("target") })}</>;
  if (step?.kind === "operate") return <>{t("announce.at", { place: name("device") })}</>;
  return step?.kind === "pick" || step?.kind === "drop" ? <>{t("announce.at", { place: name("at") })}</> : null;
}
