/** What was done at the site: the newest first, by kind, as far back as one asks; to take away as a table. */
import { Button } from "@mantine/core";
import { Cpu, Download, KeyRound, ShieldCheck } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { AuditEntry } from "@/api/types";
import { Avatar } from "@/design/Avatar";
import { Chip } from "@/design/Chip";
import { useNow } from "@/design/useNow";
import { formatTime } from "@/i18n/format";
import { LoadProblem } from "@/shell/LoadProblem";
import { TableSkeleton } from "../TableSkeleton";
import { actorWords, byDay, deedWords, placeWords } from "./auditWords";
import { exportPath, KINDS, useAudit, type AuditFilter } from "./people";
import styles from "./settings.module.css";

const SIGNS = { token: KeyRound, device: Cpu, vipo: ShieldCheck };
const FILTERS: readonly AuditFilter[] = ["all", ...KINDS];

function Sign({ line }: { line: AuditEntry }) {
  if (line.actor_kind === "person") return <Avatar name={line.actor} size={26} />;
  const Icon = SIGNS[line.actor_kind];
  return (
    <span className={styles.sign}>
      <Icon size={15} aria-hidden="true" />
    </span>
  );
}

function Line({ line }: { line: AuditEntry }) {
  return (
    <li className={styles.line}>
      <Sign line={line} />
      <div>
        <p>
          <strong>{actorWords(line)}</strong> {deedWords(line)}
        </p>
        <small>{[formatTime(line.at), placeWords(line)].filter(Boolean).join(", ")}</small>
      </div>
    </li>
  );
}

function Days({ lines }: { lines: readonly AuditEntry[] }) {
  const now = useNow(60_000);
  return byDay(lines, now).map(([day, of]) => (
    <section key={day} aria-label={day}>
      <h3>{day}</h3>
      <ol className={styles.lines}>
        {of.map((line) => (
          <Line key={line.id} line={line} />
        ))}
      </ol>
    </section>
  ));
}

function Filters({ filter, choose }: { filter: AuditFilter; choose: (filter: AuditFilter) => void }) {
  const { t } = useTranslation();
  return (
    <div className={styles.filters} role="group" aria-label={t("people.audit.filter")}>
      {FILTERS.map((kind) => (
        <button key={kind} type="button" aria-pressed={kind === filter} onClick={() => choose(kind)}>
          {t(`people.audit.kind.${kind}`)}
        </button>
      ))}
    </div>
  );
}

export function AuditPane({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const [filter, setFilter] = useState<AuditFilter>("all");
  const audit = useAudit(slug, filter);
  const first = audit.data?.pages[0];
  const lines = audit.data?.pages.flatMap((page) => page.items) ?? [];
  return (
    <aside className={styles.audit} aria-label={t("people.audit.title")}>
      <div className={styles.head}>
        <h2>{t("people.audit.title")}</h2>
        {first ? <Chip>{first.headers.get("X-Total-Count")}</Chip> : null}
        <Button
          className={styles.last}
          component="a"
          href={exportPath(slug, filter)}
          download
          size="xs"
          variant="default"
          leftSection={<Download size={15} aria-hidden="true" />}
        >
          {t("people.audit.export")}
        </Button>
      </div>
      <Filters filter={filter} choose={setFilter} />
      <div className={styles.record} role="region" aria-label={t("people.audit.lines")} tabIndex={0}>
        {audit.isLoadingError ? <LoadProblem error={audit.error} again={() => void audit.refetch()} /> : null}
        {audit.isPending ? <TableSkeleton /> : null}
        {first && lines.length === 0 ? <p className={styles.none}>{t("people.audit.none")}</p> : null}
        <Days lines={lines} />
        {audit.isFetchNextPageError ? (
          <LoadProblem error={audit.error} again={() => void audit.fetchNextPage()} />
        ) : null}
        {audit.hasNextPage && !audit.isFetchNextPageError ? (
          <Button
            variant="default"
            size="xs"
            loading={audit.isFetchingNextPage}
            onClick={() => void audit.fetchNextPage()}
          >
            {t("people.audit.older")}
          </Button>
        ) : null}
      </div>
      {first ? (
        <p className={styles.kept}>
          <ShieldCheck size={15} aria-hidden="true" />
          {t("people.audit.kept", { days: first.headers.get("X-Kept-Days") })}
        </p>
      ) : null}
    </aside>
  );
}
