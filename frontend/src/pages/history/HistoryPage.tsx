/** The versions of a program: who drew them and when, what they are about, which runs used them. */
import { Button } from "@mantine/core";
import { History } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link, useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useProgram, useRelatives, useSite, useVersions } from "@/api/queries";
import { useVersionRuns } from "@/api/runs";
import type { Program, Site, Version } from "@/api/types";
import { compareAddress, DRAFT, otherSideOf } from "@/compare/sides";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { useVersionTests } from "@/shell/review/versionTests";
import { mayEdit } from "../programs/NewProgram";
import { TableSkeleton } from "../TableSkeleton";
import styles from "./history.module.css";
import { SaveVersion } from "./SaveVersion";
import { VersionRow } from "./VersionRow";

export function HistoryPage() {
  const { slug = "", id = "" } = useParams();
  const { t } = useTranslation();
  const program = useProgram(id);
  const site = useSite(slug);
  const failed = missing(program, site);
  const title = program.data ? t("history.of", { name: program.data.name }) : t("history.title");
  return (
    <PageShell
      title={title}
      actions={program.data && site.data ? <Actions program={program.data} site={site.data} /> : null}
    >
      {failed ? (
        <LoadProblem error={failed} again={() => void [program, site].map((query) => query.refetch())} />
      ) : null}
      {program.data ? <OriginLine program={program.data} /> : null}
      {program.data && site.data ? <Versions key={id} program={program.data} site={site.data} /> : null}
      {failed || (program.data && site.data) ? null : <TableSkeleton />}
    </PageShell>
  );
}

/** From which program of another site this one was made, as far as who looks sees that site. */
function OriginLine({ program }: { program: Program }) {
  const { t } = useTranslation();
  const origin = useRelatives(program.id).data?.origin;
  if (!origin) return null;
  const behind = origin.newest - origin.version;
  return (
    <p className={styles.origin}>
      <Link to={`/programs/${origin.id}`}>{t("promote.from", { ...origin })}</Link>
      {behind > 0 ? <Chip tone="warn">{t("promote.behind", { count: behind })}</Chip> : null}
      <Link to={compareAddress(program.id, otherSideOf(origin.id, origin.newest), DRAFT)}>{t("promote.compare")}</Link>
    </p>
  );
}

function Actions({ program, site }: { program: Program; site: Site }) {
  const { t } = useTranslation();
  return (
    <>
      <Button variant="default" component={Link} to={`/programs/${program.id}`}>
        {t("history.open")}
      </Button>
      {mayEdit(site.role) ? <SaveVersion program={program} /> : null}
    </>
  );
}

function Versions({ program, site }: { program: Program; site: Site }) {
  const { t } = useTranslation();
  const query = useVersions(program.id);
  if (query.isPending) return <TableSkeleton />;
  if (query.isLoadingError) return <LoadProblem error={query.error} again={() => void query.refetch()} />;
  const parts = query.data.pages.map((page) => page.items);
  if (parts[0]?.length === 0)
    return (
      <Panel>
        <EmptyState icon={<History size={20} />} title={t("history.empty")} text={t("history.empty_text")} />
      </Panel>
    );
  return (
    <>
      <ol className={styles.versions}>
        {parts.map((versions, at) => (
          <Rows key={versions[0]?.number} {...{ versions, program, site }} before={parts[at + 1]?.[0]?.number} />
        ))}
      </ol>
      {query.isFetchNextPageError ? <LoadProblem error={query.error} again={() => void query.fetchNextPage()} /> : null}
      {query.hasNextPage && !query.isFetchNextPageError ? (
        <Button variant="default" loading={query.isFetchingNextPage} onClick={() => void query.fetchNextPage()}>
          {t("history.older")}
        </Button>
      ) : null}
    </>
  );
}

interface RowsProps {
  /** A part of the versions, the newest first. */
  versions: readonly Version[];
  /** The number of the version before them, if it is known. */
  before: number | undefined;
  program: Program;
  site: Site;
}

function Rows({ versions, before, program, site }: RowsProps) {
  const [newest, oldest] = [versions[0]?.number ?? 1, versions.at(-1)?.number ?? 1];
  const used = useVersionRuns(site.slug, program.id, oldest, newest).data;
  const tests = useVersionTests(program.id).data ?? [];
  return versions.map((version, at) => (
    <VersionRow
      key={version.number}
      version={version}
      before={versions[at + 1]?.number ?? before ?? (version.number > 1 ? version.number - 1 : null)}
      used={used && (used.find((each) => each.version === version.number) ?? null)}
      tests={tests.find(({ number }) => number === version.number)}
      program={program}
      site={site}
    />
  ));
}
