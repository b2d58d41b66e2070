/** The floor of a rehearsal: the site's map with what lay on it at the moment that is shown, and not what lies there now. */
import { useMemo } from "react";
import type { RehearsalResult, SiteMap } from "@/api/types";

/** Numbers of the things that lay on the floor at a time, with commas between. Pure. */
export function lyingAt(obstacles: RehearsalResult["obstacles"], t_s: number): string {
  return obstacles.flatMap(({ t, until }, index) => (t <= t_s && t_s < (until ?? Infinity) ? index : [])).join();
}

export function useFloorAt(map: SiteMap | undefined, result: RehearsalResult, t_s: number): SiteMap | undefined {
  const all = result.obstacles;
  const lying = lyingAt(all, t_s);
  return useMemo(() => {
    const here = all.map((each, index) => ({ ...each, id: index }));
    return map && { ...map, obstacles: here.filter(({ id }) => lying.split(",").includes(String(id))) };
  }, [map, all, lying]);
}
