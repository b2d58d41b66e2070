/** The whole course of a rehearsal, line by line; a press on a line goes to its moment. */
import { useTranslation } from "react-i18next";
import { clock } from "@/design/clock";
import { logWords } from "./logWords";
import styles from "./ResultPanel.module.css";
import type { ResultPanelProps } from "./resultProps";

export function Course({ result, nameOf, numberOf, onJump }: ResultPanelProps) {
  const { t } = useTranslation();
  if (result.log.length === 0) return null;
  return (
    <details className={styles.course}>
      <summary>{t("simulation.log.title")}</summary>
      <ol>
        {result.log.map((line, index) => (
          <li key={index}>
            <button type="button" className={styles.event} onClick={() => onJump(line.t, line.step || undefined)}>
              <span className={styles.time}>{clock(line.t)}</span>
              <span>
                {line.step ? <b>{`${numberOf(line.step)} `}</b> : null}
                {logWords(line, nameOf)}
              </span>
            </button>
          </li>
        ))}
      </ol>
    </details>
  );
}
