/** The runs of a site, and what became of one, as screens read them; the live socket writes into the same caches. */
import { type InfiniteData, skipToken, useInfiniteQuery, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { api, type ListPart } from "./client";
import { keys, type Maybe } from "./queries";
import type { RunEvent, RunSummary, RunTimeline, VersionRuns } from "./types";

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

/** Which runs used the versions of a program from one number to another; a version that none used has no entry. */
export const useVersionRuns = (slug: string, program: string, oldest: number, newest: number) =>
  useQuery({
    queryKey: [...keys.versionRuns(slug, program), oldest, newest],
    queryFn: () =>
      api.get<VersionRuns[]>(`/programs/${encodeURIComponent(program)}/version-runs?oldest=${oldest}&newest=${newest}`),
    staleTime: 0, // nobody follows it while no page shows it
  });

const LINES_AT_ONCE = 500;

/** A run's journal, part after part: the newest part first, which live news go on with, each in the order of its lines. */
export type RunJournal = InfiniteData<ListPart<RunEvent>>;

/** The newest lines of a run's journal, and with each further part those before them. */
export const useRunJournal = (id: string) =>
  useInfiniteQuery({
    queryKey: keys.runEvents(id),
    queryFn: ({ pageParam }) => api.part<RunEvent>(pageParam),
    initialPageParam: `/runs/${encodeURIComponent(id)}/events?newest=true&limit=${LINES_AT_ONCE}`,
    getNextPageParam: (last: { next?: string | undefined }) => last.next,
  });

/** A run's timeline as the server has told it, and the lines that its journal has had since. */
export interface GrowingTimeline {
  told: RunTimeline;
  since: readonly RunEvent[];
}

/** After so many lines the timeline is fetched anew, which joins what cannot be told apart. */
const MOST_SINCE = 1000;

/** A run's timeline, which live news go on with. */
export const useRunTimeline = (id: string) => {
  const queries = useQueryClient();
  const timeline = useQuery({
    queryKey: keys.runTimeline(id),
    queryFn: async (): Promise<GrowingTimeline> => ({
      told: await api.get<RunTimeline>(`/runs/${encodeURIComponent(id)}/timeline`),
      since: [],
    }),
  });
  const isLong = (timeline.data?.since.length ?? 0) >= MOST_SINCE;
  useEffect(() => {
    if (isLong) void queries.invalidateQueries({ queryKey: keys.runTimeline(id) });
  }, [isLong, queries, id]);
  return timeline;
};
