import { TextInput } from "@mantine/core";
import { Search, Workflow } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { useOpenRuns, usePrograms, useSite } from "@/api/queries";
import { useRuns } from "@/api/runs";
import type { Program } from "@/api/types";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { mayEdit, NewProgramButton } from "./NewProgram";
import { NothingFound } from "../NothingFound";
import styles from "../pages.module.css";
import { ProgramTable } from "./ProgramTable";
import { TableSkeleton } from "../TableSkeleton";

function Programs({ slug, programs }: { slug: string; programs: Program[] }) {
  const { t } = useTranslation();
  const [query, setQuery] = useState("");
  const runs = useRuns(slug).data;
  const open = useOpenRuns(slug).data;
  const role = useSite(slug).data?.role;
  const wanted = query.trim().toLowerCase();
  const found = programs.filter((program) => program.name.toLowerCase().includes(wanted));
  if (programs.length === 0)
    return (
      <Panel>
        <EmptyState icon={<Workflow size={20} />} title={t("pages.programs.none")} text={t("pages.programs.noneText")}>
          <NewProgramButton slug={slug} />
        </EmptyState>
      </Panel>
    );
  return (
    <div className={styles.stack}>
      <TextInput
        className={styles.search}
        leftSection={<Search size={16} aria-hidden="true" />}
        aria-label={t("pages.programs.search")}
        placeholder={t("pages.programs.search")}
        value={query}
        onChange={(event) => setQuery(event.target.value)}
      />
      <Panel>
        {found.length > 0 ? (
          <ProgramTable programs={found} runs={runs} open={open} editable={mayEdit(role)} />
        ) : (
          <NothingFound clear={() => setQuery("")} />
        )}
      </Panel>
    </div>
  );
}

export function ProgramsPage() {
  const { t } = useTranslation();
  const { slug = "" } = useParams();
  const programs = usePrograms(slug);
  return (
    <PageShell
      title={t("shell.nav.programs")}
      chips={programs.data ? <Chip>{t("pages.programs.count", { count: programs.data.length })}</Chip> : null}
      actions={<NewProgramButton slug={slug} />}
    >
      {programs.isPending ? <TableSkeleton /> : null}
      {programs.isLoadingError ? <LoadProblem error={programs.error} again={() => void programs.refetch()} /> : null}
      {programs.data ? <Programs slug={slug} programs={programs.data} /> : null}
    </PageShell>
  );
}
