/** How VIPO works for a site: what waits, what is overdue, and for admins the processes that carry it. */
import { CircleCheck } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useFindings, useOperations, useProcesses, useSite } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Finding } from "@/api/types";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { StatusGlyph } from "@/design/StatusGlyph";
import { useNow } from "@/design/useNow";
import { formatSpan } from "@/i18n/format";
import { findingWords, seesOperations } from "@/shell/findings/findings";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";
import { LeaseTable } from "./LeaseTable";
import { OverdueTable } from "./OverdueTable";
import { ProcessTable } from "./ProcessTable";
import { QueueTable } from "./QueueTable";
import { SetAside } from "./setAside/SetAside";
import { Waiting } from "./Waiting";
import styles from "./operations.module.css";

/** Answers older than this are said to be old; they come every two seconds. */
const OLD_MS = 8_000;

function FindingList({ findings }: { findings: readonly Finding[] }) {
  const { t } = useTranslation();
  return (
    <Panel className={styles.findings} aria-label={t("operations.findings")}>
      <ul>
        {findings.map((finding) => (
          <li key={findingWords(finding)} data-severity={finding.severity}>
            <StatusGlyph status={finding.severity} size={16} />
            <span>
              <span className="visually-hidden">{t(`operations.severity.${finding.severity}`)}: </span>
              {findingWords(finding)}
            </span>
          </li>
        ))}
      </ul>
    </Panel>
  );
}

function Facts({ findings, alerts }: { findings: readonly Finding[] | undefined; alerts: number }) {
  const { t } = useTranslation();
  if (!findings) return null;
  const isGrave = findings.some((finding) => finding.severity === "error");
  return (
    <>
      {findings.length === 0 ? (
        <Chip tone="done">
          <CircleCheck size={14} aria-hidden="true" />
          {t("operations.well")}
        </Chip>
      ) : (
        <Chip tone={isGrave ? "error" : "warn"}>{t("operations.wrong", { count: findings.length })}</Chip>
      )}
      {alerts > 0 ? <Chip tone="warn">{t("operations.alerts", { count: alerts })}</Chip> : null}
    </>
  );
}

/** That no answer comes is said once; how long ago the last one was, which changes each second, is only shown. */
function Age({ at }: { at: number }) {
  const { t } = useTranslation();
  const age = useNow(1000) - at;
  const isOld = at > 0 && age > OLD_MS;
  return (
    <p className={isOld ? styles.old : "visually-hidden"}>
      <span role="status">{isOld ? t("operations.old") : null}</span>{" "}
      {isOld ? <span>{t("operations.lastAnswer", { ago: formatSpan(age / 1000) })}</span> : null}
    </p>
  );
}

export function OperationsPage() {
  const { slug = "" } = useParams();
  return <OperationsOfSite key={slug} slug={slug} />;
}

function OperationsOfSite({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const site = useSite(slug);
  const role = site.data?.role;
  const mayLook = seesOperations(role);
  const isForOthers = role !== undefined && !mayOperate(role);
  const findings = useFindings(mayLook ? slug : undefined);
  const operations = useOperations(mayLook ? slug : undefined);
  const processes = useProcesses(role === "admin" ? slug : undefined);
  const problem = missing(site, operations);
  const found = findings.data;
  return (
    <PageShell
      title={t("operations.title")}
      chips={<Facts findings={found} alerts={operations.data?.open_alerts ?? 0} />}
    >
      <div className={pages.stack}>
        {problem ? (
          <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), operations.refetch()])} />
        ) : null}
        {isForOthers ? (
          <Panel>
            <EmptyState title={t("operations.notForYou")} />
          </Panel>
        ) : null}
        {!problem && !isForOthers && operations.isPending ? <TableSkeleton /> : null}
        <Age at={operations.dataUpdatedAt} />
        {found?.length ? <FindingList findings={found} /> : null}
        {role === "admin" ? <SetAside slug={slug} /> : null}
        {operations.data ? <Waiting slug={slug} operations={operations.data} /> : null}
        {operations.data ? <OverdueTable slug={slug} operations={operations.data} /> : null}
        {processes.data ? <ProcessTable processes={processes.data.processes} /> : null}
        {processes.data ? (
          <div className={styles.pair}>
            <QueueTable queues={processes.data.queues} />
            <LeaseTable leases={processes.data.leases} />
          </div>
        ) : null}
      </div>
    </PageShell>
  );
}
