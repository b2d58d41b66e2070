/** What a site keeps for how long: read, chosen, and the fields in which people choose it. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { Retention, SetKeeping } from "@/api/types";

const keyOf = (slug: string) => ["retention", slug] as const;
const pathOf = (slug: string) => `/sites/${encodeURIComponent(slug)}/retention`;
/** A hundred years. */
const MOST_DAYS = 36_500;

export const useRetention = (slug: string | undefined) =>
  useQuery({
    queryKey: keyOf(slug ?? ""),
    queryFn: () => api.get<Retention>(pathOf(slug ?? "")),
    enabled: slug !== undefined,
  });

export function useSetKeeping(slug: string) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (chosen: SetKeeping) => api.put<Retention>(pathOf(slug), chosen),
    onSuccess: (retention) => queries.setQueryData(keyOf(slug), retention),
  });
}

/** Days as they were typed: null for an empty field, undefined for what is no whole number of days. */
export function readDays(typed: string): number | null | undefined {
  const text = typed.trim();
  if (text === "") return null;
  return /^\d{1,5}$/.test(text) && Number(text) <= MOST_DAYS ? Number(text) : undefined;
}
