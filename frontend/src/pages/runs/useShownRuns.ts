/** The runs of a site as the screen lists them: without a gap, as far down as somebody has asked. */
import { NEWEST_RUNS, useRunParts, useRuns } from "@/api/runs";
import { joinRuns } from "./runStatus";

/**
 * The newest runs, which live news keep, and the older ones, which the server gives in parts. Fetched anew, there are as
 * many parts as were asked for: where many runs have begun meanwhile, they end at a newer one.
 */
export function useShownRuns(slug: string) {
  const runs = useRuns(slug);
  const newest = runs.data;
  const parts = useRunParts(slug, (newest?.length ?? 0) >= NEWEST_RUNS);
  const known = parts.data?.pages.flatMap(({ items }) => items) ?? [];
  // Live news tell of older runs, too: one below the last part waits for its own.
  const last = parts.hasNextPage ? (known.at(-1)?.number ?? 0) : 0;
  return { runs, parts, shown: joinRuns(newest ?? [], known).filter((run) => run.number >= last) };
}
