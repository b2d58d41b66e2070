/** Functions that people made from steps, to be used again in other programs. */
import { Button, Checkbox, TextInput } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { Search, SquareFunction } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useParams } from "react-router-dom";
import { ApiProblem } from "@/api/client";
import { useLibrary, useLibraryFunction } from "@/api/queries";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { FunctionCard } from "./FunctionCard";
import { FunctionDetail } from "./FunctionDetail";
import styles from "./library.module.css";
import { NoSuch } from "../NoSuch";
import { NothingFound } from "../NothingFound";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";

function EmptyLibrary({ slug }: { slug: string }) {
  const { t } = useTranslation();
  return (
    <Panel>
      <EmptyState icon={<SquareFunction size={20} />} title={t("library.none")} text={t("library.noneText")}>
        <Button component={Link} to={`/sites/${slug}/programs`}>
          {t("pages.runs.toPrograms")}
        </Button>
      </EmptyState>
    </Panel>
  );
}

/** How many there are; of a long list only how many are shown is known. */
function Count({ count, hasMore }: { count: number; hasMore: boolean }) {
  const { t } = useTranslation();
  return <Chip>{hasMore ? t("library.first", { count }) : t("library.functions", { count })}</Chip>;
}

interface BeyondProps {
  slug: string;
  error: Error;
  again: () => void;
}

/** An address that leads to a function which is not here, or not any more; or which could not be fetched. */
function NoFunction({ slug, error, again }: BeyondProps) {
  const { t } = useTranslation();
  if (!(error instanceof ApiProblem && error.status === 404)) return <LoadProblem error={error} again={again} />;
  return <NoSuch words={t("library.noSuch")} list={`/sites/${slug}/library`} toList={t("library.toList")} />;
}

export function LibraryPage() {
  const { t } = useTranslation();
  const { slug = "", id } = useParams();
  const [typed, setTyped] = useState("");
  const [query] = useDebouncedValue(typed.trim(), 200);
  const [fitting, setFitting] = useState(false);
  const found = useLibrary(query, slug, fitting);
  const { hasNextPage, isFetchNextPageError, fetchNextPage } = found;
  const items = found.data ?? [];
  const narrowed = query !== "" || fitting;
  const clear = () => {
    setTyped("");
    setFitting(false);
  };
  const beyond = useLibraryFunction(
    found.isSuccess && !found.data.some((item) => item.id === id) ? id : undefined,
    slug,
  );
  const chosen = found.data?.find((item) => item.id === id) ?? beyond.data;
  return (
    <PageShell
      title={t("shell.nav.library")}
      chips={found.data ? <Count count={items.length} hasMore={hasNextPage} /> : null}
      detail={chosen ? <FunctionDetail key={chosen.id} slug={slug} item={chosen} /> : null}
    >
      <div className={pages.stack}>
        <div className={styles.filters}>
          <TextInput
            className={pages.search}
            leftSection={<Search size={16} aria-hidden="true" />}
            aria-label={t("library.search")}
            placeholder={t("library.search")}
            value={typed}
            onChange={(event) => setTyped(event.target.value)}
          />
          <Checkbox
            label={t("library.fitsOnly")}
            title={t("library.fitsOnlyHelp")}
            checked={fitting}
            onChange={(event) => setFitting(event.currentTarget.checked)}
          />
        </div>
        {beyond.isLoadingError && !chosen ? (
          <NoFunction slug={slug} error={beyond.error} again={() => void beyond.refetch()} />
        ) : null}
        {found.isPending ? <TableSkeleton /> : null}
        {found.isLoadingError ? <LoadProblem error={found.error} again={() => void found.refetch()} /> : null}
        {found.data && items.length === 0 && narrowed ? <NothingFound clear={clear} /> : null}
        {found.data && items.length === 0 && !narrowed ? <EmptyLibrary slug={slug} /> : null}
        <ul className={styles.cards}>
          {items.map((item) => (
            <FunctionCard key={item.id} slug={slug} item={item} chosen={item.id === id} />
          ))}
        </ul>
        {isFetchNextPageError ? <LoadProblem error={found.error} again={() => void fetchNextPage()} /> : null}
        {hasNextPage && !isFetchNextPageError ? (
          <Button variant="default" loading={found.isFetchingNextPage} onClick={() => void fetchNextPage()}>
            {t("library.more")}
          </Button>
        ) : null}
      </div>
    </PageShell>
  );
}
