/** What a property was, over a range that people choose. */
import { useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { Series } from "@/api/types";

export const RANGES = ["now", "hour", "day", "week"] as const;
export type Range = (typeof RANGES)[number];

const MINUTE_MS = 60_000;
export const RANGE_MS: Readonly<Record<Range, number>> = {
  now: 2 * MINUTE_MS,
  hour: 60 * MINUTE_MS,
  day: 24 * 60 * MINUTE_MS,
  week: 7 * 24 * 60 * MINUTE_MS,
};
const POINTS = 120;

/** Asked for again every minute, but for the last minutes: what is newer comes live. */
export function useHistory(slug: string, device: string, property: string, range: Range) {
  const base = `/sites/${slug}/devices/${encodeURIComponent(device)}/history?property=${property}&points=${POINTS}`;
  const ask = () => api.get<Series>(`${base}&since=${new Date(Date.now() - RANGE_MS[range]).toISOString()}`);
  return useQuery({
    queryKey: ["history", slug, device, property, range],
    queryFn: ask,
    refetchInterval: range === "now" ? false : MINUTE_MS,
    staleTime: MINUTE_MS,
  });
}
