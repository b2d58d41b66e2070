import { Button } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Measured, RunEvent } from "@/api/types";
import { StatusGlyph, type StatusName } from "@/design/StatusGlyph";
import { VipoIcon } from "@/design/VipoIcon";
import { clock } from "@/design/clock";
import { paceOf, percentOver } from "@/device/paces/paces";
import { StandInMark } from "@/device/standIn/StandInMark";
import { formatNumber } from "@/i18n/format";
import { waitWords } from "@/i18n/waits";
import comments from "./comments/runComments.module.css";
import styles from "./RunScreen.module.css";
import { eventWords } from "./eventWords";
import type { JournalLines } from "./journalLines";
import { outerProgress, spentSeconds, type StepLine } from "./stepList";

const FAR_PERCENT = 20;
/** So many lines of a journal are on the screen at first, and so many more come at a press: a run may write for days. */
const LINES = 500;
const GLYPHS: Record<StepLine["status"], StatusName> = {
  waiting: "idle",
  running: "busy",
  done: "done",
  failed: "error",
  skipped: "offline",
};

interface RunStepsProps {
  lines: StepLine[];
  current: StepLine | null;
  now: number;
  selected: string | null;
  titleOf: (step: string) => string;
  iconOf: (step: string) => string;
  nameOf: (device: string) => string;
  /** What steps took at work, beside what was predicted. */
  measured: ReadonlyMap<string, Measured>;
  onSelect: (step: string) => void;
}

/** By how much a step took longer than its devices' copies, where that is worth a word. */
function Beside({ measured }: { measured: Measured | undefined }) {
  const { t } = useTranslation();
  const percent = measured ? percentOver(paceOf(measured)) : 0;
  if (!measured || percent === 0) return null;
  const words = t("device.paces.step", {
    real: formatNumber(measured.real_s, 1),
    predicted: formatNumber(measured.predicted_s, 1),
  });
  return (
    <span className={styles.beside} data-far={Math.abs(percent) >= FAR_PERCENT || undefined} title={words}>
      <span aria-hidden="true">
        {percent > 0 ? "+" : "−"}
        {formatNumber(Math.abs(percent))} %
      </span>
      <span className="visually-hidden">{words}</span>
    </span>
  );
}

/** Waiting with a beginning means held up; without one it has not begun. */
function glyphOf(line: StepLine): StatusName {
  return line.status === "waiting" && line.started_at ? "waiting" : GLYPHS[line.status];
}

function Current({ current, now, titleOf, nameOf }: RunStepsProps) {
  const { t } = useTranslation();
  if (!current) return null;
  return (
    <div className={styles.current} data-waiting={current.wait ? true : undefined}>
      <p>
        <span className={styles.number}>{current.number}</span> <b>{titleOf(current.step)}</b>
      </p>
      <p className={styles.currentNote}>
        <span>
          {waitWords(current.why, nameOf) ??
            current.wait ??
            (current.robot ? nameOf(current.robot) : t("run.underWay"))}
        </span>
        <span>{clock(spentSeconds(current, now) ?? 0)}</span>
      </p>
    </div>
  );
}

function Line({ line, props }: { line: StepLine; props: RunStepsProps }) {
  const { t } = useTranslation();
  const spent = spentSeconds(line, props.now);
  const word = t(`run.step.${glyphOf(line) === "waiting" ? "held" : line.status}`);
  return (
    <li>
      <button
        type="button"
        className={styles.line}
        aria-current={props.current?.step === line.step ? "step" : undefined}
        aria-pressed={props.selected === line.step}
        style={{ paddingLeft: 12 + line.depth * 18 }}
        onClick={() => props.onSelect(line.step)}
      >
        <StatusGlyph status={glyphOf(line)} size={15} />
        <span className="visually-hidden">{word}</span>
        <span className={styles.number}>{line.number}</span>
        <VipoIcon name={props.iconOf(line.step)} size={15} />
        <span className={styles.lineTitle} title={props.titleOf(line.step)}>
          {props.titleOf(line.step)}
        </span>
        {line.count > 1 ? <span className={styles.mono}>{t("run.times", { count: line.count })}</span> : null}
        <Beside measured={props.measured.get(line.step)} />
        <span className={styles.mono}>{spent === null ? "–" : clock(spent)}</span>
      </button>
    </li>
  );
}

/** The step that is being carried out, and all steps with their state and time. */
export function RunSteps(props: RunStepsProps) {
  const { t } = useTranslation();
  const progress = outerProgress(props.lines);
  return (
    <>
      <Current {...props} />
      <section className={styles.steps} aria-label={t("run.steps")}>
        <h2>
          {t("run.steps")} <small>{t("run.stepsDone", progress)}</small>
        </h2>
        <ol>
          {props.lines.map((line) => (
            <Line key={line.step} line={line} props={props} />
          ))}
        </ol>
      </section>
    </>
  );
}

const KINDS: Record<string, StatusName> = {
  wait: "waiting",
  answer: "done",
  command: "busy",
  failed: "error",
  question: "waiting",
};

function eventGlyph(event: RunEvent): StatusName {
  if (event.code === "step_done" || event.code === "finished") return "done";
  if (event.code.startsWith("step_") && event.code !== "step_entered") return "error";
  if (event.kind === "answer" && event.args.status !== "DONE") return "error";
  if (event.code === "answered") return "done";
  if (event.code === "told" && event.args.level === "warning") return "warning";
  return KINDS[event.kind] ?? "idle";
}

/** A line about a device for which a simulated one was told or has answered. */
export const isSimulated = (event: RunEvent): boolean => event.args.simulated === true;

interface JournalProps {
  journal: JournalLines;
  numberOf: (step: string) => string;
  nameOf: (device: string) => string;
  label: string;
  full?: boolean;
  /** Begin a comment on a line; nothing for those who may not. By keys one is begun on the timeline. */
  onWrite: ((event: RunEvent) => void) | null;
}

/** When a line was written; for those who may comment, the way to comment on it. */
function Time({ event, onWrite }: { event: RunEvent; onWrite: JournalProps["onWrite"] }) {
  const { t } = useTranslation();
  const at = clock(event.t_s);
  if (!onWrite) return <span className={styles.mono}>{at}</span>;
  const words = t("comments.on", { what: at });
  return (
    <button
      type="button"
      tabIndex={-1}
      className={`${styles.mono} ${comments.time}`}
      title={words}
      aria-label={words}
      onClick={() => onWrite(event)}
    >
      {at}
    </button>
  );
}

/** What happened, newest last; it stays at the newest while one looks at the end. */
export function Journal({ journal, numberOf, nameOf, label, full = false, onWrite }: JournalProps) {
  const { t } = useTranslation();
  const list = useRef<HTMLOListElement>(null);
  const { lines } = journal;
  const all = full ? lines : lines.filter((event) => !["command", "way"].includes(event.kind));
  const [atEnd, setAtEnd] = useState(true);
  // Who reads further up keeps the lines there, from this number on, however many come below.
  const [kept, setKept] = useState<number | null>(null);
  const from = kept ?? all.at(-LINES)?.seq ?? 0;
  const shown = all.filter((event) => event.seq >= from);
  const hidden = all.length - shown.length;
  const older = hidden + journal.older;
  const showOlder = () => {
    setKept(all[hidden - LINES]?.seq ?? 0);
    if (hidden < LINES) journal.fetchOlder();
  };
  const newest = all.at(-1)?.seq;
  useEffect(() => {
    const element = list.current;
    if (element && atEnd) element.scrollTop = element.scrollHeight;
  }, [newest, atEnd]);
  return (
    <section className={styles.journal} aria-label={label}>
      {full ? null : (
        <h2>
          {label} {journal.older > 0 ? null : <small>{t("run.entries", { count: all.length })}</small>}
        </h2>
      )}
      {older > 0 ? (
        <Button size="compact-xs" variant="default" loading={journal.isFetching && hidden < LINES} onClick={showOlder}>
          {t("run.older_lines", { count: older })}
        </Button>
      ) : null}
      {journal.problem ? <p role="alert">{journal.problem}</p> : null}
      <ol
        ref={list}
        // A list that scrolls must be reachable by keyboard.
        // oxlint-disable-next-line jsx-a11y/no-noninteractive-tabindex
        tabIndex={0}
        aria-label={label}
        onScroll={({ currentTarget: element }) => {
          const isAtEnd = element.scrollHeight - element.scrollTop - element.clientHeight < 40;
          if (isAtEnd === atEnd) return;
          setAtEnd(isAtEnd);
          setKept(isAtEnd ? null : (shown[0]?.seq ?? 0));
        }}
      >
        {shown.map((event) => (
          <li key={event.seq}>
            <Time event={event} onWrite={onWrite} />
            <StatusGlyph status={eventGlyph(event)} size={13} />
            <span>
              {event.step && numberOf(event.step) ? <b>{numberOf(event.step)} </b> : null}
              {eventWords(event, nameOf)} {isSimulated(event) ? <StandInMark /> : null}
            </span>
          </li>
        ))}
      </ol>
    </section>
  );
}
