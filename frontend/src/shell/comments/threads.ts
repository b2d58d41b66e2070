/** A program's threads of comments: read, written, resolved; what changes comes with the site's live feed. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { CommentOnRun, Thread, ThreadBegun, ThreadToStart, WordsToWrite } from "@/api/types";
import type { Named } from "./mentions";

export const FILTERS = ["open", "mine", "resolved"] as const;
export type Filter = (typeof FILTERS)[number];

const pathOf = (program: string) => `/programs/${program}`;

export const useThreads = (program: string) =>
  useQuery({ queryKey: keys.threads(program), queryFn: () => api.get<Thread[]>(`${pathOf(program)}/threads`) });

/** Whom one may mention; asked for by whoever writes alone. */
export const usePeopleToMention = (program: string) =>
  useQuery({
    queryKey: keys.peopleToMention(program),
    queryFn: () => api.get<Named[]>(`${pathOf(program)}/people`),
  });

/** Begin a thread about a moment of a run of the program. */
export function useCommentOnRun(program: string, run: string) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (comment: CommentOnRun) => api.post<ThreadBegun>(`/runs/${run}/threads`, comment),
    onSettled: () => queries.invalidateQueries({ queryKey: keys.threads(program) }),
  }).mutateAsync;
}

/** What one does in a program's threads; all is read anew after each. */
export function useCommenting(program: string) {
  const queries = useQueryClient();
  const { mutateAsync, isPending } = useMutation({
    mutationFn: (act: () => Promise<unknown>) => act(),
    onSettled: () => queries.invalidateQueries({ queryKey: keys.threads(program) }),
  });
  const path = pathOf(program);
  return {
    isPending,
    start: (thread: ThreadToStart) => mutateAsync(() => api.post(`${path}/threads`, thread)),
    answer: (thread: string, words: WordsToWrite) =>
      mutateAsync(() => api.post(`${path}/threads/${thread}/comments`, words)),
    resolve: (thread: string, resolved: boolean) =>
      mutateAsync(() => api.patch(`${path}/threads/${thread}`, { resolved })),
    markRead: (thread: string) => mutateAsync(() => api.post(`${path}/threads/${thread}/read`)),
    edit: (comment: string, words: WordsToWrite) => mutateAsync(() => api.patch(`${path}/comments/${comment}`, words)),
    remove: (comment: string) => mutateAsync(() => api.delete(`${path}/comments/${comment}`)),
  };
}

/** How many comments of others somebody has not read, in threads that are open. */
export function countUnread(threads: readonly Thread[]): number {
  return threads.filter((each) => !each.resolved_at).reduce((sum, each) => sum + each.unread, 0);
}

export function filterThreads(threads: readonly Thread[], filter: Filter, me: number | undefined): Thread[] {
  return threads.filter((thread) => {
    if (filter === "resolved") return thread.resolved_at !== null;
    if (filter === "open") return thread.resolved_at === null;
    return thread.comments.some((each) => me !== undefined && each.mentions.some(({ id }) => id === me));
  });
}
