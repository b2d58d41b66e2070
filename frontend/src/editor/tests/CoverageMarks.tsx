/** On the map at each step: how many tests come there, and what of it none of them takes. */
import { useReactFlow, useStoreApi } from "@xyflow/react";
import { Check, TriangleAlert } from "lucide-react";
import { useEffect, useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import type { Chip } from "@/program/scene/chips";
import { useOpenProgram } from "../state/context";
import { select } from "../state/ui";
import { marksOf, wordsOf } from "./coverage";
import classes from "./tests.module.css";
import { useTests, useTestsUi } from "./tests";

/** More marks than these would make moving the map slow; those of what is never tested come first. */
const MOST = 300;

export function CoverageMarks() {
  const shown = useTestsUi((ui) => ui.marks && ui.shown);
  return shown ? <Marks /> : null;
}

function Marks() {
  const { program, scene } = useOpenProgram();
  const coverage = useTests(program.id).data?.coverage;
  const marks = useMemo(() => {
    const all = marksOf(coverage?.constructs ?? []).flatMap((mark) => {
      const chip = scene.chips.get(mark.step);
      return chip ? [{ ...mark, chip }] : [];
    });
    return all.sort((one, other) => Number(other.missed.length > 0) - Number(one.missed.length > 0)).slice(0, MOST);
  }, [coverage, scene]);
  const plane = useOwnSize();
  return (
    <div ref={plane} className={`${classes.marks} nopan nodrag`} data-stale={coverage?.stale || undefined}>
      {marks.map((mark) => (
        <Mark key={mark.step} chip={mark.chip} tests={mark.tests} missed={mark.missed} />
      ))}
    </div>
  );
}

function Mark({ chip, tests, missed }: { chip: Chip; tests: number; missed: readonly string[] }) {
  const { t } = useTranslation();
  const words = missed.map((way) => (way === "reached" ? t("tests.never") : wordsOf(way, t))).join(", ");
  const style = { left: chip.at.x + chip.width / 2, top: chip.at.y - chip.height / 2 };
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
