/** On the map at each step: how many tests come there, and what of it none of them takes. */
import { useReactFlow, useStoreApi } from "@xyflow/react";
import { Check, TriangleAlert } from "lucide-react";
import { type CSSProperties, useEffect, useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import type { Chip } from "@/program/scene/chips";
import { useOpenProgram } from "../state/context";
import { select } from "../state/ui";
import { liftsOf, marksOf, wordsOf } from "./coverage";
import classes from "./tests.module.css";
import { useTests, useTestsUi } from "./tests";

/** More marks than these would make moving the map slow; those of what is never tested come first. */
const MOST = 300;

export function CoverageMarks() {
  const shown = useTestsUi((ui) => ui.marks && ui.shown);
  return shown ? <Marks /> : null;
}

function Marks() {
  const { t } = useTranslation();
  const { program, scene } = useOpenProgram();
  const coverage = useTests(program.id).data?.coverage;
  const marks = useMemo(() => {
    const all = marksOf(coverage?.constructs ?? []).flatMap((mark) => {
      const chip = scene.chips.get(mark.step);
      return chip ? [{ ...mark, chip }] : [];
    });
    const shown = all
      .sort((one, other) => Number(one.missed.length > 0) - Number(other.missed.length > 0))
      .slice(-MOST);
    const told = shown.map((mark) => ({ ...mark, words: missedWords(mark.missed, t) }));
    const lifts = liftsOf(told.map(({ chip, tests, words }) => ({ ...cornerOf(chip), width: widthOf(tests, words) })));
    return told.map((mark, index) => ({ ...mark, lift: lifts[index] ?? 0 }));
  }, [coverage, scene, t]);
  const plane = useOwnSize();
  return (
    <div ref={plane} className={`${classes.marks} nopan nodrag`} data-stale={coverage?.stale || undefined}>
      {marks.map((mark) => (
        <Mark key={mark.step} {...mark} />
      ))}
    </div>
  );
}

const cornerOf = (chip: Chip) => ({ x: chip.at.x + chip.width / 2, y: chip.at.y - chip.height / 2 });

const missedWords = (missed: readonly string[], t: (key: string) => string) =>
  missed.map((way) => (way === "reached" ? t("tests.never") : wordsOf(way, t))).join(", ");

/** About as wide as it is drawn: a number, and words that are cut. */
function widthOf(tests: number, words: string): number {
  return (tests > 0 ? 36 : 0) + (words ? Math.min(195, 30 + 6 * words.length) : 0);
}

interface MarkProps {
  chip: Chip;
  tests: number;
  /** What none takes, empty if there is nothing. */
  words: string;
  /** Pixels that it stands higher, so that it covers no other. */
  lift: number;
}

function Mark({ chip, tests, words, lift }: MarkProps) {
  const { t } = useTranslation();
  const { x: left, y: top } = cornerOf(chip);
  const style = { left, top, "--lift": `${String(lift)}px` } as CSSProperties;
  return (
    <div className={classes.mark} style={style}>
      {tests > 0 ? (
        <span className={classes.taken} title={t("tests.taken_in", { count: tests })}>
          <Check size={11} strokeWidth={3} aria-hidden="true" />
          {tests}
        </span>
      ) : null}
      {words ? (
        <button type="button" className={classes.never} title={words} tabIndex={-1} onClick={() => select([chip.id])}>
          <TriangleAlert size={11} aria-hidden="true" />
          <span>{words}</span>
        </button>
      ) : null}
    </div>
  );
}

/** Marks lie in the map's plane and are moved by it; that they keep their own size is told to them all at once. */
function useOwnSize() {
  const store = useStoreApi();
  const flow = useReactFlow();
  const element = useRef<HTMLDivElement>(null);
  useEffect(() => {
    let told = 0;
    const tell = () => {
      const zoom = flow.getZoom();
      if (zoom === told) return;
      element.current?.style.setProperty("--out", String(1 / zoom));
      element.current?.toggleAttribute("data-far", zoom < 0.7);
      told = zoom;
    };
    tell();
    return store.subscribe(tell);
  }, [store, flow]);
  return element;
}
