/** The runs of a site as the screen lists them: without a gap, as far down as somebody has asked. */
import { useEffect, useRef } from "react";
import { NEWEST_RUNS, useRunParts, useRuns } from "@/api/queries";
import { joinRuns } from "./runStatus";

/** The newest runs, which live news keep, and the older ones, which the server gives in parts. */
export function useShownRuns(slug: string) {
  const runs = useRuns(slug);
  const newest = runs.data;
  const parts = useRunParts(slug, (newest?.length ?? 0) >= NEWEST_RUNS);
  const { hasNextPage, isFetching, isError, fetchNextPage } = parts;
  const known = parts.data?.pages.flatMap(({ items }) => items) ?? [];
  // Live news tell of older runs, too: one below the last part waits for its own.
  const last = hasNextPage ? (known.at(-1)?.number ?? 0) : 0;
  // As many parts, fetched anew, may end above a run that was shown: they go on until they reach it.
  const reached = useRef(Infinity);
  useEffect(() => {
    if (known.length === 0 || isFetching || isError) return;
    if (last > reached.current) void fetchNextPage();
    else reached.current = last;
  }, [known.length, last, isFetching, isError, fetchNextPage]);
  return { runs, parts, shown: joinRuns(newest ?? [], known).filter((run) => run.number >= last) };
}
