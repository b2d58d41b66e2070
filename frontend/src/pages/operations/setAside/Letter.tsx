/** One thing that was set aside: what, for which run, why, and what an admin can do with it. */
import { Button } from "@mantine/core";
import { RotateCcw, Trash2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { DeadLetter } from "@/api/types";
import { useFocusAfter } from "@/design/useReturnFocus";
import { formatAgo, formatMoment } from "@/i18n/format";
import pages from "../../pages.module.css";
import { eventText, isOver, whatWords } from "./letterWords";
import styles from "./setAside.module.css";

interface LetterProps {
  letter: DeadLetter;
  now: number;
  /** Whether this one is being retried. */
  retries: boolean;
  onRetry: () => void;
  onDrop: (from: HTMLElement) => void;
  /** Who has the focus when this one goes while it had it. */
  afterwards: () => HTMLElement | null;
}

function Facts({ letter, now }: { letter: DeadLetter; now: number }) {
  const { t } = useTranslation();
  return (
    <p className={styles.facts}>
      {letter.run ? (
        <>
          <Link to={`/runs/${letter.run}`} className={pages.link}>
            {t("operations.runNumber", { number: letter.run_number ?? "–" })}
          </Link>
          {` · ${t(`run.status.${letter.run_status ?? "paused"}`)}`}
        </>
      ) : (
        t("operations.setAside.noRun")
      )}
      {` · ${formatAgo(letter.at, now)}`}
    </p>
  );
}

function Why({ letter }: { letter: DeadLetter }) {
  const { t } = useTranslation();
  return (
    <details className={styles.why}>
      <summary>{t("operations.setAside.why")}</summary>
      <dl>
        <dt>{t("operations.setAside.error")}</dt>
        <dd>
          <code>{letter.error}</code>
        </dd>
        <dt>{t("operations.setAside.when")}</dt>
        <dd>{formatMoment(letter.at)}</dd>
        <dt>{t("operations.setAside.said")}</dt>
        <dd>
          <pre>{eventText(letter)}</pre>
        </dd>
      </dl>
    </details>
  );
}

export function Letter({ letter, now, retries, onRetry, onDrop, afterwards }: LetterProps) {
  const { t } = useTranslation();
  useFocusAfter(afterwards);
  const what = whatWords(letter);
  const of = letter.run_number === null ? what : `${t("operations.runNumber", { number: letter.run_number })}: ${what}`;
  return (
    <li className={styles.letter}>
      <div className={styles.body}>
        <p className={pages.strong}>{what}</p>
        <Facts letter={letter} now={now} />
      </div>
      <div className={styles.buttons}>
        {isOver(letter) ? null : (
          <Button
            size="xs"
            variant="default"
            leftSection={<RotateCcw size={14} aria-hidden="true" />}
            aria-label={`${t("operations.setAside.retry")}: ${of}`}
            aria-busy={retries}
            onClick={onRetry}
          >
            {t("operations.setAside.retry")}
          </Button>
        )}
        <Button
          size="xs"
          variant="default"
          c="var(--error)"
          leftSection={<Trash2 size={14} aria-hidden="true" />}
          aria-label={`${t("operations.setAside.drop")}: ${of}`}
          onClick={(event) => onDrop(event.currentTarget)}
        >
          {t("operations.setAside.drop")}
        </Button>
      </div>
      <Why letter={letter} />
    </li>
  );
}
