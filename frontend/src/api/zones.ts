/** A site's zones: made, changed and removed by its admins, opened and closed by who runs programs. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "./client";
import { staleWithSiteMap } from "./robotMaps";
import type { MapZone, ZoneCost } from "./types";

export type ZoneRule = MapZone["rule"];
export const ZONE_RULES: readonly ZoneRule[] = ["keep_out", "release", "slow", "one_at_a_time", "one_way", "preferred"];

export type ZoneFields = Partial<Omit<MapZone, "id" | "points" | "open_until">> & {
  points?: readonly (readonly [number, number])[];
};

export type ZoneChange =
  | { do: "add"; zone: ZoneFields }
  | { do: "edit"; id: string; fields: ZoneFields }
  | { do: "remove"; id: string }
  /** To all robots, for so long from now. */
  | { do: "open"; id: string; minutes: number }
  | { do: "close"; id: string };

function send(slug: string, change: ZoneChange): Promise<MapZone | undefined> {
  const path = `/sites/${slug}/zones`;
  switch (change.do) {
    case "add":
      return api.post<MapZone>(path, change.zone);
    case "edit":
      return api.patch<MapZone>(`${path}/${encodeURIComponent(change.id)}`, change.fields);
    case "remove":
      return api.delete<undefined>(`${path}/${encodeURIComponent(change.id)}`);
    case "open":
      return api.put<MapZone>(`${path}/${encodeURIComponent(change.id)}/opening`, { minutes: change.minutes });
    case "close":
      return api.delete<undefined>(`${path}/${encodeURIComponent(change.id)}/opening`);
  }
}

/** How long robots waited in rehearsals before the zones that take only so many; known anew for each map. */
export const useZoneCosts = (slug: string, zones: readonly MapZone[]) =>
  useQuery({
    queryKey: ["zone-costs", slug, zones],
    queryFn: () => api.get<ZoneCost[]>(`/sites/${slug}/zone-costs`),
    enabled: zones.some(({ rule }) => rule === "one_at_a_time"),
  });

/**
 * Change a zone; whatever comes of it, the map's zones are fetched anew. Changes go out one after another. Each refusal
 * is told, also where another change has followed, or nobody shows the zone any more.
 */
export function useChangeZone(slug: string, onRefused: (error: Error) => void) {
  const queries = useQueryClient();
  return useMutation({
    scope: { id: `zones ${slug}` },
    mutationFn: (change: ZoneChange) => send(slug, change),
    onError: onRefused,
    onSettled: () =>
      Promise.all(staleWithSiteMap(slug).map((queryKey) => queries.invalidateQueries({ queryKey, exact: false }))),
  });
}
