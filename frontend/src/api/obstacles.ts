/** What people put in the way of a site's simulated robots. */
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { api } from "./client";
import { keys } from "./queries";
import type { Obstacle } from "./types";

type ObstacleFields = Omit<Obstacle, "id">;
export type ObstacleChange =
  | { do: "add"; obstacle: ObstacleFields }
  | { do: "move"; id: number; obstacle: ObstacleFields }
  | { do: "remove"; id: number }
  | { do: "removeAll" };

function send(slug: string, change: ObstacleChange): Promise<Obstacle | undefined> {
  const path = `/sites/${slug}/obstacles`;
  switch (change.do) {
    case "add":
      return api.post<Obstacle>(path, change.obstacle);
    case "move":
      return api.put<Obstacle>(`${path}/${change.id}`, change.obstacle);
    case "remove":
      return api.delete<undefined>(`${path}/${change.id}`);
    case "removeAll":
      return api.delete<undefined>(path);
  }
}

/**
 * Change what lies on the floor; whatever comes of it, the map is fetched anew. Changes go out one after another. A
 * refusal is told also where nobody shows the obstacle any more.
 */
export function useChangeObstacles(slug: string, onRefused: (error: Error) => void) {
  const queries = useQueryClient();
  return useMutation({
    scope: { id: `obstacles ${slug}` },
    mutationFn: (change: ObstacleChange) => send(slug, change),
    onError: onRefused,
    onSettled: () => queries.invalidateQueries({ queryKey: keys.map(slug), exact: false }),
  });
}
