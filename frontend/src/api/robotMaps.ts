/** The maps that robots send, the versions of a site's map, and what changes from one to another. */
import { skipToken, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api, ApiProblem } from "./client";
import { keys } from "./queries";
import type { MapDifference, MapVersion, RobotMap, RobotMapInfo } from "./types";
import { getWholeMap } from "./wholeMap";

/** Which maps: by their numbers and, as another map may have one once a backup is brought back, their tags. */
interface Maps {
  version: number;
  tag: string;
  replaces: number;
  replaces_tag: string;
}

export type MapChange = ({ do: "use"; device: string } & Maps) | ({ do: "restore" } & Maps);

export const mapKeys = {
  robot: (slug: string, device: string) => ["robot-map", slug, device] as const,
  difference: (slug: string, device: string) => ["map-difference", slug, device] as const,
  differences: (slug: string) => ["map-difference", slug] as const,
  versions: (slug: string) => ["map-versions", slug] as const,
};

const pathOf = (slug: string, device: string) => `/sites/${slug}/devices/${encodeURIComponent(device)}/map`;

export const robotMapFile = (slug: string, device: string, form: "yaml" | "pgm") =>
  `/api${pathOf(slug, device)}.${form}`;

async function getRobotMap(slug: string, device: string): Promise<RobotMap | null> {
  try {
    return await getWholeMap<RobotMapInfo>(pathOf(slug, device));
  } catch (error) {
    if (error instanceof ApiProblem && error.code === "no_robot_map") return null;
    throw error;
  }
}

/** The newest map of a robot; null when it has sent none. */
export const useRobotMap = (slug: string, device: string) =>
  useQuery({ queryKey: mapKeys.robot(slug, device), queryFn: () => getRobotMap(slug, device) });

export const useMapDifference = (slug: string, device: string) =>
  useQuery({
    queryKey: mapKeys.difference(slug, device),
    queryFn: () => api.get<MapDifference>(`${pathOf(slug, device)}/difference`),
    staleTime: 0,
  });

export const useMapVersions = (slug: string, wanted: boolean) =>
  useQuery({
    queryKey: mapKeys.versions(slug),
    queryFn: wanted ? () => api.get<MapVersion[]>(`/sites/${slug}/map/versions`) : skipToken,
  });

/** The caches of what depends on a site's map. */
export const staleWithSiteMap = (slug: string) => [
  keys.map(slug),
  keys.site(slug),
  keys.sites,
  mapKeys.versions(slug),
  mapKeys.differences(slug),
  ["tests"], // their results are of the site as it was
];

/** Change the site's map; whatever comes of it, what is shown of it is fetched anew. */
export function useChangeMap(slug: string, onRefused: (error: Error) => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: ({ do: act, ...body }: MapChange) =>
      api.post<{ version: number }>(`/sites/${slug}/map/${act === "use" ? "from-device" : "restore"}`, body),
    onError: onRefused,
    onSettled: () => {
      for (const queryKey of staleWithSiteMap(slug)) void queries.invalidateQueries({ queryKey });
    },
  });
}
