/** Where everybody arrives: how to begin, what is live, the sites, their programs and last runs. */
import { Button } from "@mantine/core";
import { Building2, Workflow } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { useCurrentSite } from "@/shell/currentSite";
import { useMe, useOpenRuns, usePrograms, useSites } from "@/api/queries";
import { useRuns } from "@/api/runs";
import type { Site } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { BeginCard } from "./BeginCard";
import { LiveNow } from "./LiveNow";
import { RecentRuns } from "./RecentRuns";
import { SiteCards } from "./SiteCards";
import { StartCard } from "./StartCard";
import styles from "./home.module.css";
import { mayEdit, NewProgramButton } from "../programs/NewProgram";
import { ProgramTable } from "../programs/ProgramTable";
import { TableSkeleton } from "../TableSkeleton";

function SitePart({ site }: { site: Site }) {
  const { t } = useTranslation();
  const programs = usePrograms(site.slug);
  const runs = useRuns(site.slug).data;
  const open = useOpenRuns(site.slug).data;
  return (
    <>
      <h2 className={styles.heading}>{t("pages.home.programsIn", { site: site.name })}</h2>
      <div className={styles.row}>
        <Panel className={styles.programs}>
          {programs.data?.length ? (
            <ProgramTable programs={programs.data.slice(0, 6)} runs={runs} open={open} editable={mayEdit(site.role)} />
          ) : null}
          {programs.data?.length === 0 ? (
            <EmptyState
              icon={<Workflow size={20} />}
              title={t("pages.programs.none")}
              text={t("pages.programs.noneText")}
            >
              <NewProgramButton slug={site.slug} />
            </EmptyState>
          ) : null}
          {programs.isPending ? <TableSkeleton rows={4} /> : null}
          {programs.isLoadingError ? (
            <LoadProblem error={programs.error} again={() => void programs.refetch()} />
          ) : null}
        </Panel>
        <RecentRuns slug={site.slug} runs={runs} />
      </div>
    </>
  );
}

function NoSites() {
  const { t } = useTranslation();
  const mayAdd = useMe().data?.may_create_sites ?? false;
  return (
    <Panel>
      <EmptyState
        icon={<Building2 size={20} />}
        title={t("pages.home.noSites")}
        text={t(mayAdd ? "pages.home.noSitesText" : "pages.home.askForSite")}
      >
        {mayAdd ? (
          <Button component={Link} to="/sites/new">
            {t("shell.site.add")}
          </Button>
        ) : null}
      </EmptyState>
    </Panel>
  );
}

export function HomePage() {
  const { t } = useTranslation();
  const { site } = useCurrentSite();
  const sites = useSites();
  return (
    <PageShell title={t("shell.nav.home")} actions={site ? <NewProgramButton slug={site.slug} /> : null}>
      {sites.isLoadingError ? <LoadProblem error={sites.error} again={() => void sites.refetch()} /> : null}
      {sites.isPending ? <TableSkeleton /> : null}
      {sites.data?.length === 0 ? <NoSites /> : null}
      {site ? (
        <div className={styles.home}>
          <div className={styles.row}>
            <StartCard site={site} otherwise={<BeginCard site={site} />} />
            <LiveNow slug={site.slug} />
          </div>
          <h2 className={styles.heading}>{t("pages.home.sites")}</h2>
          <SiteCards sites={sites.data ?? []} />
          <SitePart site={site} />
        </div>
      ) : null}
    </PageShell>
  );
}
