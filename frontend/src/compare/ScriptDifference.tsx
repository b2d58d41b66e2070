/** Both scripts line by line beside each other; the lines of the chosen change come into sight. */
import { ChevronDown, ChevronUp, FileCode } from "lucide-react";
import { useEffect, useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { ConstructChange } from "@/api/types";
import styles from "./compare.module.css";
import { countLines, type LinePair, linePairs, type ScriptLine } from "./lines";
import type { Pictures } from "./usePictures";

interface ScriptProps {
  pictures: Pictures;
  chosen: ConstructChange | null;
  /** The changes that can be chosen. */
  known: readonly string[];
  onChoose: (key: string) => void;
}

export function ScriptDifference({ pictures, chosen, known, onChoose }: ScriptProps) {
  const { t } = useTranslation();
  const [open, setOpen] = useState(true);
  const [old, next] = [pictures.old.compiled, pictures.new.compiled];
  const pairs = useMemo(() => (old && next ? linePairs(old, next) : []), [old, next]);
  const counts = countLines(pairs);
  return (
    <section className={styles.drawer} data-open={open || undefined} aria-label={t("compare.script")}>
      <header className={styles.drawerHead}>
        <button type="button" aria-expanded={open} aria-controls="script-difference" onClick={() => setOpen(!open)}>
          <FileCode size={15} aria-hidden="true" /> {t("compare.script")}
          {open ? <ChevronDown size={14} aria-hidden="true" /> : <ChevronUp size={14} aria-hidden="true" />}
        </button>
        {pairs.length > 0 ? (
          <span className={styles.lineCounts}>
            <b data-kind="added">{t("compare.lines_added", { count: counts.added })}</b>
            <b data-kind="removed">{t("compare.lines_removed", { count: counts.removed })}</b>
          </span>
        ) : null}
      </header>
      {/* A region that scrolls must be reachable by keyboard. */}
      <div
        id="script-difference"
        className={styles.script}
        hidden={!open}
        tabIndex={0}
        role="region"
        aria-label={t("compare.lines")}
      >
        <Lines {...{ pairs, known, onChoose }} step={chosen?.root === "steps" ? chosen.id : null} />
      </div>
    </section>
  );
}

interface LinesProps {
  pairs: readonly LinePair[];
  step: string | null;
  known: readonly string[];
  onChoose: (key: string) => void;
}

function Lines({ pairs, step, known, onChoose }: LinesProps) {
  const { t } = useTranslation();
  const body = useRef<HTMLTableSectionElement>(null);
  useEffect(() => {
    if (step) body.current?.querySelector("[data-chosen]")?.scrollIntoView({ block: "nearest" });
  }, [step, pairs]);
  return (
    <table className={styles.lines}>
      <thead className="visually-hidden">
        <tr>
          <th colSpan={3}>{t("compare.show.old")}</th>
          <th colSpan={3}>{t("compare.show.new")}</th>
        </tr>
      </thead>
      <tbody ref={body}>
        {pairs.map((pair, index) => {
          const chosen = step !== null && (pair.old?.step === step || pair.new?.step === step);
          return (
            // The lines of two versions stand still; the index is the pair's name.
            <tr key={index} data-chosen={chosen || undefined}>
              <Half line={pair.old} kind={pair.same ? null : "removed"} {...{ known, onChoose }} />
              <Half line={pair.new} kind={pair.same ? null : "added"} {...{ known, onChoose }} />
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

interface HalfProps {
  line: ScriptLine | null;
  kind: "added" | "removed" | null;
  known: readonly string[];
  onChoose: (key: string) => void;
}

function Half({ line, kind, known, onChoose }: HalfProps) {
  const { t } = useTranslation();
  if (!line)
    return (
      <>
        <td data-empty />
        <td data-empty />
        <td data-empty />
      </>
    );
  const key = `steps/${line.step}`;
  const sign = kind ? t(`compare.sign.${kind}`) : "";
  return (
    <>
      <td className={styles.lineNumber} data-kind={kind ?? undefined}>
        {line.line}
      </td>
      <td data-kind={kind ?? undefined}>
        {line.number && known.includes(key) ? (
          <button type="button" className={styles.number} onClick={() => onChoose(key)}>
            {line.number}
          </button>
        ) : line.number ? (
          <span className={styles.number}>{line.number}</span>
        ) : null}
      </td>
      <td data-kind={kind ?? undefined}>
        <code>
          <span className={styles.sign}>{sign}</span>
          {line.text}
        </code>
      </td>
    </>
  );
}
