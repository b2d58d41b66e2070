/** What a site's floor offers robots: what they cannot come to, and where one is in another's way. */
import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { api } from "./client";
import type { Device, FloorCheck, FloorFinding, FloorRemedy, SiteMap } from "./types";

/** What a check depends on; robots that drive change nothing of it. */
function stampOf({ tag, places, zones }: SiteMap, devices: readonly Device[]): string {
  const approved = devices.filter(({ lifecycle }) => lifecycle === "approved");
  const parts = approved.map(({ id, kind, radius_m, location, size }) =>
    kind === "robot" ? [id, radius_m] : [id, location, size],
  );
  return JSON.stringify([tag, places, zones, parts]);
}

/** The check for robots of a width in metres, or for the site's widest; the one before stays until the next is here. */
export const useFloorCheck = (
  slug: string,
  map: SiteMap,
  devices: readonly Device[],
  { width_m = null, enabled = true }: { width_m?: number | null; enabled?: boolean } = {},
) =>
  useQuery({
    enabled,
    queryKey: ["floor-check", slug, stampOf(map, devices), width_m],
    queryFn: () => {
      const width = width_m === null ? "" : `?width_m=${width_m}`;
      return api.get<FloorCheck>(`/sites/${slug}/floor-check${width}`);
    },
    placeholderData: keepPreviousData,
  });

/** What would mend a finding of that check; for admins. */
export const useRemedies = (
  slug: string,
  map: SiteMap,
  devices: readonly Device[],
  { code, target, other }: FloorFinding,
  { width_m, enabled }: { width_m: number | null; enabled: boolean },
) =>
  useQuery({
    enabled,
    queryKey: ["floor-check", slug, stampOf(map, devices), width_m, "remedies", code, target, other],
    queryFn: () => {
      const asked = new URLSearchParams({ code, target });
      if (other !== null) asked.set("other", other);
      if (width_m !== null) asked.set("width_m", String(width_m));
      return api.get<FloorRemedy[]>(`/sites/${slug}/floor-check/remedies?${asked}`);
    },
  });
