/** One thing that was set aside: what, for which run, why, and what an admin can do with it. */
import { Button } from "@mantine/core";
import { RotateCcw, Trash2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { DeadLetter } from "@/api/types";
import { useFocusAfter } from "@/design/useReturnFocus";
import pages from "../../pages.module.css";
import { Facts, Why } from "./LetterFacts";
import { isOver, whatWords } from "./letterWords";
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
