/** How long a site keeps what has ended, what takes how many bytes, and what is in the archive; for admins. */
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite } from "@/api/queries";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import pages from "../pages.module.css";
import { SettingsTabs } from "../settings/SettingsTabs";
import { TableSkeleton } from "../TableSkeleton";
import { useRetention } from "./retention";
import { ArchiveTable, ProgramTable } from "./Tables";
import { Times } from "./Times";
import styles from "./retention.module.css";

export function RetentionPage() {
  const { slug = "" } = useParams();
  return <RetentionOfSite key={slug} slug={slug} />;
}

function RetentionOfSite({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const site = useSite(slug);
  const isAdmin = site.data?.role === "admin";
  const retention = useRetention(isAdmin ? slug : undefined);
  const problem = missing(site, retention);
  const isForOthers = site.data !== undefined && !isAdmin;
  return (
    <PageShell title={t("retention.title")}>
      <SettingsTabs slug={slug} role={site.data?.role} />
      <div className={pages.stack}>
        {problem ? (
          <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), retention.refetch()])} />
        ) : null}
        {isForOthers ? (
          <Panel>
            <EmptyState title={t("retention.notForYou")} />
          </Panel>
        ) : null}
        {!problem && !isForOthers && !retention.data ? <TableSkeleton /> : null}
        {retention.data?.trouble ? (
          <p className={styles.trouble} role="status">
            {t("retention.trouble", { why: retention.data.trouble })}
          </p>
        ) : null}
        {retention.data ? <Times slug={slug} retention={retention.data} /> : null}
        {retention.data ? <ProgramTable retention={retention.data} /> : null}
        {retention.data ? <ArchiveTable retention={retention.data} /> : null}
      </div>
    </PageShell>
  );
}
