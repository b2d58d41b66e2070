/** Moving a place or machine on a site's map, where it still stands as the asker has seen it. */
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { api } from "./client";
import { keys } from "./queries";
import { staleWithSiteMap } from "./robotMaps";
import type { Device, MapPlace } from "./types";

type Point = readonly [number, number];

export interface Moved {
  readonly kind: "place" | "machine";
  readonly id: string;
  readonly from: Point;
  readonly to: Point;
}

/** Two points of the map are the same within a millimetre. */
const isAt = ({ x, y }: { x: number; y: number }, [wantedX, wantedY]: Point) =>
  Math.hypot(x - wantedX, y - wantedY) < 0.001;

/** Tell whether it was moved: who moved it meanwhile is not overruled. */
async function send(slug: string, { kind, id, from, to: [x, y] }: Moved): Promise<boolean> {
  const path = `/sites/${slug}/${kind === "place" ? "places" : "devices"}/${encodeURIComponent(id)}`;
  if (kind === "place") {
    if (!isAt(await api.get<MapPlace>(path), from)) return false;
    await api.patch(path, { x, y });
    return true;
  }
  const { location } = await api.get<Device>(path);
  if (!isAt(location, from)) return false;
  await api.patch(path, { location: { ...location, x, y } });
  return true;
}

export function useMoveOnMap(slug: string) {
  const queries = useQueryClient();
  return useMutation({
    scope: { id: `places ${slug}` },
    mutationFn: (moved: Moved) => send(slug, moved),
    onSettled: () =>
      Promise.all(
        [...staleWithSiteMap(slug), keys.devices(slug), keys.site(slug)].map((queryKey) =>
          queries.invalidateQueries({ queryKey, exact: false }),
        ),
      ),
  });
}
