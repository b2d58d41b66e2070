/** The runs of a site as screens read them; the live socket writes into the same caches. */
import { skipToken, useInfiniteQuery, useQuery } from "@tanstack/react-query";
import { api, type ListPart } from "./client";
import { keys, type Maybe } from "./queries";
import type { RunSummary } from "./types";

/** The newest runs of a site: as live news keep them, and the part of the list that the server gave last. */
export interface NewestRuns {
  runs: RunSummary[];
  part: ListPart<RunSummary>;
}

/** How many runs `useRuns` gives at most, apart from those that have changed since. */
export const NEWEST_RUNS = 50;

const newestRuns = (slug: string) => ({
  queryKey: keys.runs(slug),
  queryFn: async (): Promise<NewestRuns> => {
    const part = await api.part<RunSummary>(`/sites/${encodeURIComponent(slug)}/runs`);
    return { runs: part.items, part };
  },
});
const runsOf = ({ runs }: NewestRuns) => runs;

/** The newest runs of a site, over or not; an older one may still be under way. */
export const useRuns = (slug: Maybe) => {
  const { queryKey, queryFn } = newestRuns(slug ?? "");
  return useQuery({ queryKey, queryFn: slug ? queryFn : skipToken, select: runsOf });
};

/**
 * A site's runs as the server has them, the newest first, part after part. The first part is the one that `useRuns` has
 * been given. Fetched anew, each part begins where the one before ends, so that however many runs have begun meanwhile
 * none is missing between them.
 */
export const useRunParts = (slug: string, wanted: boolean) =>
  useInfiniteQuery({
    queryKey: [...keys.runs(slug), "parts"],
    queryFn: wanted
      ? async ({ client, pageParam: path }) =>
          path === null ? (await client.fetchQuery(newestRuns(slug))).part : api.part<RunSummary>(path)
      : skipToken,
    initialPageParam: null as string | null,
    getNextPageParam: (last: { next?: string | undefined }) => last.next,
  });
