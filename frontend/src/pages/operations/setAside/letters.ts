/** What was set aside at a site: read over and over, tried again or dropped. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api, untilRefused } from "@/api/client";
import { keys } from "@/api/queries";
import type { DeadLetter } from "@/api/types";

/** As often as what else this page shows. */
const EVERY_MS = 2_000;
/** As in execution/engine/dead_letters.py. */
export const MOST = 200;

const keyOf = (slug: string) => ["dead-letters", slug] as const;

export const useOpenLetters = (slug: string) =>
  useQuery({
    queryKey: keyOf(slug),
    queryFn: () => api.get<DeadLetter[]>(`/sites/${encodeURIComponent(slug)}/dead-letters?state=open`),
    refetchInterval: untilRefused(EVERY_MS),
    staleTime: 0,
  });

/** What was retried or dropped, the last first; nobody waits for news of it. */
export const useSettledLetters = (slug: string) =>
  useQuery({
    queryKey: [...keyOf(slug), "settled"],
    queryFn: () => api.get<DeadLetter[]>(`/sites/${encodeURIComponent(slug)}/dead-letters?state=settled`),
    staleTime: 0,
  });

export interface Settling {
  letter: DeadLetter;
  what: "retry" | "drop";
}

export function useSettle(slug: string) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: ({ letter, what }: Settling) => api.post<DeadLetter>(`/dead-letters/${letter.id}/${what}`),
    onSettled: () =>
      Promise.all(
        [keyOf(slug), keys.findings(slug), keys.operations(slug)].map((queryKey) =>
          queries.invalidateQueries({ queryKey }),
        ),
      ),
  });
}
