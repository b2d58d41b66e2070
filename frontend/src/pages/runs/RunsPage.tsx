import { History } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link, useParams } from "react-router-dom";
import { Button } from "@mantine/core";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { useOpenRuns } from "@/api/queries";
import type { RunSummary } from "@/api/types";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { StatusBadge } from "@/design/StatusBadge";
import { formatAgo, formatSpan } from "@/i18n/format";
import { reasonWords } from "@/i18n/reasons";
import { isOpen } from "@/live/messages";
import { RunTerms } from "@/run/RunTerms";
import { isPlanned } from "@/run/terms";
import styles from "../pages.module.css";
import { nameOf } from "../people";
import { secondsOfRun, statusOfRun, stepsDone, underWay } from "./runStatus";
import { TableSkeleton } from "../TableSkeleton";
import { useShownRuns } from "./useShownRuns";
import { useNow } from "@/design/useNow";

function Row({ run, now }: { run: RunSummary; now: number }) {
  const { t } = useTranslation();
  const seconds = secondsOfRun(run, now);
  return (
    <tr>
      <td>
        <Link to={`/runs/${run.id}`} className={`${styles.strong} ${styles.nowrap}`}>
          {t("pages.runs.number", { number: run.number })}
        </Link>
      </td>
      <td className={styles.name}>
        <Link to={`/programs/${run.program.id}`} className={styles.strong} title={run.program.name}>
          {run.program.name}
        </Link>
      </td>
      <td>
        <StatusBadge status={statusOfRun(run)}>
          {t(isPlanned(run, now) ? "run.terms.planned" : `pages.runs.status.${run.status}`)}
        </StatusBadge>
        <span className={styles.terms}>
          <RunTerms run={run} now={now} />
        </span>
        {run.reason ? <small className={styles.reason}>{reasonWords(run.cause, run.reason)}</small> : null}
      </td>
      <td className={`${styles.nowrap} ${styles.roomy}`}>{run.started_at && !run.archived ? stepsDone(run) : "–"}</td>
      <td className={styles.nowrap}>{run.started_at ? formatAgo(run.started_at, now) : t("pages.runs.notStarted")}</td>
      <td className={styles.nowrap}>{seconds === null ? "–" : formatSpan(seconds)}</td>
      <td className={`${styles.nowrap} ${styles.optional}`}>{nameOf(run.started_by) || "–"}</td>
    </tr>
  );
}

function RunTable({ runs }: { runs: RunSummary[] }) {
  const { t } = useTranslation();
  const now = useNow(runs.some(isOpen) ? 1000 : 15_000);
  return (
    <Panel className={styles.scroll}>
      <table className={styles.table}>
        <thead>
          <tr>
            {["run", "program", "status", "steps", "started", "took", "by"].map((column) => (
              <th key={column} scope="col" className={column === "by" ? styles.optional : undefined}>
                {t(`pages.runs.column.${column}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {runs.map((run) => (
            <Row key={run.id} run={run} now={now} />
          ))}
        </tbody>
      </table>
    </Panel>
  );
}

export function RunsPage() {
  const { slug = "" } = useParams();
  return <RunsOfSite key={slug} slug={slug} />;
}

function RunsOfSite({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const { runs, shown, parts } = useShownRuns(slug);
  const again = () => void (parts.isFetchNextPageError ? parts.fetchNextPage() : parts.refetch());
  const now = useNow(15_000);
  const open = underWay(useOpenRuns(slug).data ?? [], now).length;
  return (
    <PageShell
      title={t("shell.nav.runs")}
      chips={open > 0 ? <Chip tone="busy">{t("pages.runs.openNow", { count: open })}</Chip> : null}
    >
      {runs.isPending ? <TableSkeleton /> : null}
      {runs.isLoadingError ? <LoadProblem error={runs.error} again={() => void runs.refetch()} /> : null}
      {runs.data?.length ? <RunTable runs={shown} /> : null}
      {parts.isError ? <LoadProblem error={parts.error} again={again} /> : null}
      {parts.hasNextPage && !parts.isError ? (
        <Button variant="default" loading={parts.isFetchingNextPage} onClick={() => void parts.fetchNextPage()}>
          {t("pages.runs.showOlder")}
        </Button>
      ) : null}
      {runs.data?.length === 0 ? (
        <Panel>
          <EmptyState icon={<History size={20} />} title={t("pages.runs.none")} text={t("pages.runs.noneText")}>
            <Button component={Link} to={`/sites/${slug}/programs`}>
              {t("pages.runs.toPrograms")}
            </Button>
          </EmptyState>
        </Panel>
      ) : null}
    </PageShell>
  );
}
