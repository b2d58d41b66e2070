/** How a site's floor was used in its runs of the last days: where robots drove, and where they waited. */
import { useQuery } from "@tanstack/react-query";
import { api } from "./client";
import type { FloorUse } from "./types";

export const USE_DAYS = 7;
const FRESH_MS = 60_000;

/** By how many minutes the days of whoever looks begin before those of UTC, now. */
export const utcOffset = (now = new Date()): number => 0 - now.getTimezoneOffset();

/** Asked for only where somebody looks at it. */
export const useFloorUse = (slug: string, { enabled }: { enabled: boolean }) => {
  const offset = utcOffset();
  return useQuery({
    enabled,
    queryKey: ["floor-use", slug, USE_DAYS, offset],
    queryFn: () => api.get<FloorUse>(`/sites/${slug}/floor-use?days=${USE_DAYS}&utc_offset_min=${offset}`),
    staleTime: FRESH_MS,
  });
};
