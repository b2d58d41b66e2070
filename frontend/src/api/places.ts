/** A site's named places: made, changed and removed by its admins. */
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { api } from "./client";
import { staleWithSiteMap } from "./robotMaps";
import type { MapPlace } from "./types";

export type PlaceKind = "dock" | "room" | "point";
export const PLACE_KINDS: readonly PlaceKind[] = ["point", "dock", "room"];

export type PlaceFields = Partial<Pick<MapPlace, "name" | "kind" | "x" | "y" | "theta">>;

export type PlaceChange =
  | { do: "add"; place: { name: string; kind: PlaceKind; x: number; y: number } }
  | { do: "edit"; id: string; fields: PlaceFields }
  | { do: "remove"; id: string };

function send(slug: string, change: PlaceChange): Promise<MapPlace | undefined> {
  const path = `/sites/${slug}/places`;
  switch (change.do) {
    case "add":
      return api.post<MapPlace>(path, change.place);
    case "edit":
      return api.patch<MapPlace>(`${path}/${encodeURIComponent(change.id)}`, change.fields);
    case "remove":
      return api.delete<undefined>(`${path}/${encodeURIComponent(change.id)}`);
  }
}

/**
 * Change a place; whatever comes of it, the map's places are fetched anew. Changes go out one after another. Each refusal
 * is told, also where another change has followed, or nobody shows the place any more.
 */
export function useChangePlace(slug: string, onRefused: (error: Error) => void) {
  const queries = useQueryClient();
  return useMutation({
    scope: { id: `places ${slug}` },
    mutationFn: (change: PlaceChange) => send(slug, change),
    onError: onRefused,
    onSettled: () =>
      Promise.all(staleWithSiteMap(slug).map((queryKey) => queries.invalidateQueries({ queryKey, exact: false }))),
  });
}
