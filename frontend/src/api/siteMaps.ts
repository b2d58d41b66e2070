/** Another map for a site: what it would change, and making it the site's. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import i18next from "i18next";
import { api, ApiProblem } from "./client";
import { mapKeys, staleWithSiteMap } from "./robotMaps";
import type { components } from "./schema";
import type { MapVersion } from "./types";
import { getWholeMap } from "./wholeMap";

export type BroughtMapDifference = components["schemas"]["BroughtMapDifference"];
type MapVersionInfo = components["schemas"]["OldMapShape"];
export type MapSource = "upload" | "picture" | "drawing" | "edit";

interface Brought {
  form: FormData;
  source: MapSource;
  /** The tag of the site's map that it replaces, null: the site has none. */
  replaces: string | null;
}

/** Make a map the site's; refused with 412 where another one holds by now. */
export function useBringMap(slug: string) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: ({ form, source, replaces }: Brought) => {
      form.set("source", source);
      const known: Record<string, string> = replaces ? { "If-Match": replaces } : { "If-None-Match": "*" };
      return api.upload<{ version: number }>(`/sites/${slug}/map/upload`, form, known);
    },
    onSettled: () => {
      for (const queryKey of staleWithSiteMap(slug)) void queries.invalidateQueries({ queryKey });
    },
  });
}

/**
 * An earlier version of a site's map, without its places, which stand over all versions. It is asked for each time: once
 * a backup is brought back, another map may have its number, which is not shown as this one. Cells that the browser has
 * are not sent again.
 */
export const useOldMap = (slug: string, { version, tag }: MapVersion) =>
  useQuery({
    queryKey: ["old-map", slug, version, tag],
    queryFn: async ({ client }) => {
      const found = await getWholeMap<MapVersionInfo>(`/sites/${slug}/map/versions/${String(version)}`);
      if (tag && found.tag !== tag) {
        void client.invalidateQueries({ queryKey: mapKeys.versions(slug) });
        throw new ApiProblem(409, "map_changed", i18next.t("refusal.map_changed.version"));
      }
      return { ...found, places: [] };
    },
    staleTime: 0,
  });

/** What a map would change; asked for each time anew. */
export const useLookAtMap = (slug: string) =>
  useMutation({ mutationFn: (form: FormData) => api.upload<BroughtMapDifference>(`/sites/${slug}/map/look`, form) });
