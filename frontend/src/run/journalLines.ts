/** The lines of a run's journal that are here: the newest, and as many older ones as somebody has asked for. */
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { useRunJournal } from "@/api/runs";
import type { RunEvent } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";

export interface JournalLines {
  lines: readonly RunEvent[];
  /** How many older ones there are. */
  older: number;
  fetchOlder: () => void;
  /** While an answer is under way nothing more is asked for: it would come to nothing. */
  isFetching: boolean;
  /** Why older lines did not come. */
  problem: string | null;
}

export function useJournalLines(run: string): JournalLines {
  const { t } = useTranslation();
  const { data, hasNextPage, fetchNextPage, isFetching, isFetchNextPageError, error } = useRunJournal(run);
  const lines = useMemo(() => [...(data?.pages ?? [])].reverse().flatMap(({ items }) => items), [data]);
  return {
    lines,
    // They are counted from 1, and none is missing.
    older: hasNextPage ? (lines[0]?.seq ?? 1) - 1 : 0,
    fetchOlder: () => void fetchNextPage({ cancelRefetch: false }),
    isFetching,
    problem: isFetchNextPageError ? problemText(error, t("shell.problem.screen")) : null,
  };
}
