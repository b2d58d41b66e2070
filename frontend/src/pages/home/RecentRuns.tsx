import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { NEWEST_RUNS } from "@/api/runs";
import type { RunSummary } from "@/api/types";
import { Panel } from "@/design/Panel";
import { StatusGlyph } from "@/design/StatusGlyph";
import { formatAgo, formatSpan } from "@/i18n/format";
import { reasonWords } from "@/i18n/reasons";
import { isOpen } from "@/live/messages";
import { isPlanned } from "@/run/terms";
import { secondsOfRun, statusOfRun, stepsDone } from "../runs/runStatus";
import { useNow } from "@/design/useNow";
import styles from "./home.module.css";

function RunLine({ run, now }: { run: RunSummary; now: number }) {
  const { t } = useTranslation();
  const planned = isPlanned(run, now);
  const seconds = secondsOfRun(run, now);
  const facts = [
    t(planned ? "run.terms.planned" : `pages.runs.status.${run.status}`),
    seconds === null ? "" : formatSpan(seconds),
    run.started_at && !run.archived ? t("pages.runs.stepsDone", { count: stepsDone(run) }) : "",
  ];
  const whenOf = () => {
    if (isOpen(run)) return planned ? "" : t("pages.home.now");
    return run.ended_at ? formatAgo(run.ended_at, now) : "";
  };
  return (
    <li>
      <Link to={`/runs/${run.id}`} className={styles.recent}>
        <StatusGlyph status={statusOfRun(run)} size={16} />
        <span>
          <b>{t("pages.runs.numberOf", { number: run.number, program: run.program.name })}</b>
          <span>
            {run.status === "failed" && run.reason
              ? reasonWords(run.cause, run.reason)
              : facts.filter(Boolean).join(", ")}
          </span>
        </span>
        <small>{whenOf()}</small>
      </Link>
    </li>
  );
}

export function RecentRuns({ slug, runs }: { slug: string; runs: readonly RunSummary[] | undefined }) {
  const { t } = useTranslation();
  const now = useNow();
  const shown = runs ?? [];
  return (
    <Panel className={styles.recents} aria-labelledby="recent-runs">
      <div className={styles.recentHead}>
        <h2 id="recent-runs">{t("pages.home.recentRuns")}</h2>
        {shown.length > 0 ? (
          <Link to={`/sites/${slug}/runs`}>
            {shown.length < NEWEST_RUNS ? t("pages.home.seeAll", { count: shown.length }) : t("pages.home.seeAllRuns")}
          </Link>
        ) : null}
      </div>
      <ul>
        {shown.slice(0, 5).map((run) => (
          <RunLine key={run.id} run={run} now={now} />
        ))}
      </ul>
      {runs?.length === 0 ? <p className={styles.quiet}>{t("pages.runs.noneText")}</p> : null}
    </Panel>
  );
}
