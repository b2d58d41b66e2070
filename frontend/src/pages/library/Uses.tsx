/** Who holds a function: programs and functions over the sites that one sees. */
import { useQuery } from "@tanstack/react-query";
import { SquareFunction, Workflow } from "lucide-react";
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { FunctionUses, LibraryFunction } from "@/api/types";
import { Chip } from "@/design/Chip";
import { LoadProblem } from "@/shell/LoadProblem";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";
import styles from "./library.module.css";

export function Uses({ slug, item }: { slug: string; item: LibraryFunction }) {
  const { t } = useTranslation();
  const uses = useQuery({
    queryKey: keys.libraryFunction(item.id, "uses"),
    queryFn: () => api.get<FunctionUses>(`/library/${item.id}/uses`),
  });
  if (uses.isPending) return <TableSkeleton />;
  if (uses.isError) return <LoadProblem error={uses.error} again={() => void uses.refetch()} />;
  const { programs, functions, hidden } = uses.data;
  return (
    <div className={styles.body}>
      {programs.length + functions.length === 0 ? <p className={pages.sub}>{t("library.notUsed")}</p> : null}
      <Holders title={t("library.usedBy")}>
        {programs.map((use) => (
          <li key={use.id}>
            <Workflow size={15} aria-hidden="true" />
            <Link to={`/programs/${use.id}`}>{use.name}</Link>
            <Held {...use} slug={slug} newest={item.version} />
          </li>
        ))}
      </Holders>
      <Holders title={t("library.usedByFunctions")}>
        {functions.map((use) => (
          <li key={use.id}>
            <SquareFunction size={15} aria-hidden="true" />
            <Link to={`/sites/${slug}/library/${use.id}`}>{use.name}</Link>
            <Held {...use} slug={slug} newest={item.version} />
          </li>
        ))}
      </Holders>
      {hidden > 0 ? <p className={pages.sub}>{t("library.hidden", { count: hidden })}</p> : null}
    </div>
  );
}

function Holders({ title, children }: { title: string; children: ReactNode[] }) {
  if (children.length === 0) return null;
  return (
    <section aria-label={title}>
      <h3 className={styles.section}>{title}</h3>
      <ul className={styles.holders}>{children}</ul>
    </section>
  );
}

function Held(props: { site: string; slug: string; versions: readonly number[]; newest: number }) {
  const { t } = useTranslation();
  const { site, slug, versions, newest } = props;
  return (
    <>
      {site === slug ? null : <span>{site}</span>}
      <span className={styles.held}>
        {versions.length > 0 ? <Chip mono>{t("library.holds", { versions: versions.join(", v") })}</Chip> : null}
        {versions.some((version) => version < newest) ? <Chip tone="warn">{t("library.outdated")}</Chip> : null}
      </span>
    </>
  );
}
