/** What is said of each thing that was set aside, open or settled: its run and its time, why, and what it says. */
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { DeadLetter } from "@/api/types";
import { formatAgo, formatMoment } from "@/i18n/format";
import pages from "../../pages.module.css";
import { eventText } from "./letterWords";
import styles from "./setAside.module.css";

export function Facts({ letter, now }: { letter: DeadLetter; now: number }) {
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

export function Why({ letter }: { letter: DeadLetter }) {
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
