/** The versions of a function, which of them are breaking and why, and any two of them line by line. */
import { NativeSelect } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useParams, useSearchParams } from "react-router-dom";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { FunctionComparison, FunctionReason, LibraryFunction, LibraryVersion } from "@/api/types";
import { linePairs } from "@/compare/lines";
import { Chip } from "@/design/Chip";
import { Panel } from "@/design/Panel";
import { useNow } from "@/design/useNow";
import { formatAgo } from "@/i18n/format";
import { isBreaking, reasonWords } from "@/program/words/libraryWords";
import { LoadProblem } from "@/shell/LoadProblem";
import pages from "../pages.module.css";
import { nameOf } from "../people";
import { TableSkeleton } from "../TableSkeleton";
import styles from "./library.module.css";

export function Versions({ item }: { item: LibraryFunction }) {
  const versions = useQuery({
    queryKey: keys.libraryFunction(item.id, "versions", item.version),
    queryFn: () => api.get<LibraryVersion[]>(`/library/${item.id}/versions`),
  });
  if (versions.isPending) return <TableSkeleton />;
  if (versions.isError) return <LoadProblem error={versions.error} again={() => void versions.refetch()} />;
  return (
    <div className={styles.body}>
      <VersionList versions={versions.data} />
      {versions.data.length > 1 ? <Compared item={item} versions={versions.data} /> : null}
    </div>
  );
}

function VersionList({ versions }: { versions: readonly LibraryVersion[] }) {
  const { t } = useTranslation();
  const now = useNow();
  return (
    <ul className={styles.versions}>
      {versions.map((version) => (
        <li key={version.number}>
          <div className={styles.versionHead}>
            <Chip mono>{t("library.version", { version: version.number })}</Chip>
            <Verdict reasons={version.reasons} />
            <span>{[nameOf(version.author), formatAgo(version.created_at, now)].filter(Boolean).join(", ")}</span>
          </div>
          <Reasons reasons={version.reasons ?? []} />
        </li>
      ))}
    </ul>
  );
}

function Verdict({ reasons }: { reasons: readonly FunctionReason[] | null }) {
  const { t } = useTranslation();
  if (!reasons) return <Chip>{t("library.firstVersion")}</Chip>;
  const breaks = isBreaking(reasons);
  return <Chip tone={breaks ? "warn" : "done"}>{t(breaks ? "library.breaking" : "library.compatible")}</Chip>;
}

function Reasons({ reasons }: { reasons: readonly FunctionReason[] }) {
  const { t } = useTranslation();
  if (reasons.length === 0) return null;
  return (
    <ul className={styles.reasons}>
      {reasons.map((reason) => (
        <li key={`${reason.code}/${reason.name}`} data-breaks={reason.breaks || undefined}>
          {reasonWords(t, reason)}
        </li>
      ))}
    </ul>
  );
}

/** `from` of the address says which version is looked at first, such as the one that a program holds. */
function Compared({ item, versions }: { item: LibraryFunction; versions: readonly LibraryVersion[] }) {
  const { t } = useTranslation();
  const { slug = "" } = useParams();
  const [asked] = useSearchParams();
  const numbers = versions.map((version) => version.number);
  const from = Number(asked.get("from"));
  const [old, setOld] = useState(numbers.includes(from) && from < item.version ? from : (numbers[1] ?? 1));
  const [next, setNext] = useState(item.version);
  const compared = useQuery({
    queryKey: keys.libraryFunction(item.id, "comparison", old, next),
    queryFn: () => api.get<FunctionComparison>(`/library/${item.id}/comparison?old=${old}&new=${next}`),
    staleTime: Infinity,
  });
  const choices = numbers.map((number) => ({
    value: String(number),
    label: t("library.version", { version: number }),
  }));
  return (
    <section className={styles.compared} aria-labelledby="compared">
      <h3 id="compared" className={styles.section}>
        {t("library.compare")}
      </h3>
      <div className={styles.choices}>
        <NativeSelect
          label={t("library.old")}
          data={choices}
          value={old}
          onChange={(event) => setOld(Number(event.currentTarget.value))}
        />
        <NativeSelect
          label={t("library.new")}
          data={choices}
          value={next}
          onChange={(event) => setNext(Number(event.currentTarget.value))}
        />
      </div>
      {compared.isPending ? <TableSkeleton /> : null}
      {compared.isError ? <LoadProblem error={compared.error} again={() => void compared.refetch()} /> : null}
      {compared.data ? <Difference compared={compared.data} /> : null}
      <Link className={styles.toPicture} to={`/sites/${slug}/library/${item.id}/compare?old=${old}&new=${next}`}>
        {t("compare.function.picture")}
      </Link>
    </section>
  );
}

function Difference({ compared }: { compared: FunctionComparison }) {
  const { t } = useTranslation();
  const { reasons, old } = compared;
  const key = isBreaking(reasons) ? "library.breakingSince" : "library.compatibleSince";
  return (
    <>
      <p role="status">{t(key, { version: old.version })}</p>
      {reasons.length === 0 ? <p className={pages.sub}>{t("library.nothingElse")}</p> : <Reasons reasons={reasons} />}
      <Lines compared={compared} />
    </>
  );
}

const noSteps = (script: string) => ({ script, lines: [], numbers: {} });

/** What is on one side alone; of what is on both, one copy. */
function Lines({ compared }: { compared: FunctionComparison }) {
  const { t } = useTranslation();
  const { old, new: next } = compared;
  const pairs = useMemo(() => linePairs(noSteps(old.script), noSteps(next.script)), [old.script, next.script]);
  if (pairs.every((pair) => pair.same)) return <p className={pages.sub}>{t("library.sameScript")}</p>;
  const rows = pairs.flatMap((pair) =>
    pair.same
      ? [{ sign: "", line: pair.new }]
      : [
          { sign: "−", line: pair.old },
          { sign: "+", line: pair.new },
        ],
  );
  return (
    <Panel className={styles.script}>
      {/* A region that scrolls must be reachable by keyboard. */}
      <div className={styles.lines} role="region" aria-label={t("library.lines")} tabIndex={0}>
        {rows.map(({ sign, line }, index) =>
          line ? (
            // The lines of two versions stand still; the index is the line's name.
            <div key={index} data-sign={sign || undefined}>
              <span aria-hidden="true">{line.line}</span>
              <code>{`${sign || " "} ${line.text}`}</code>
            </div>
          ) : null,
        )}
      </div>
    </Panel>
  );
}
