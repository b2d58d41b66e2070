/** Robots that wait to be let into a zone of a site. */
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "./client";
import { keys } from "./queries";
import type { AwaitedAdmission } from "./types";

const NONE: readonly AwaitedAdmission[] = [];

/** Who waits to be let into which zone; the site's feed says when that is another. */
export function useAwaitedAdmissions(slug: string): readonly AwaitedAdmission[] {
  const { data } = useQuery({
    queryKey: keys.admissions(slug),
    queryFn: () => api.get<AwaitedAdmission[]>(`/sites/${slug}/admissions`),
  });
  return data ?? NONE;
}

/** Let a robot in; whatever comes of it, who waits is asked anew. */
export function useLetIn(slug: string) {
  const queries = useQueryClient();
  return async ({ zone, robot }: AwaitedAdmission) => {
    try {
      await api.post(`/sites/${slug}/zones/${encodeURIComponent(zone)}/admissions`, { robot });
    } finally {
      await queries.invalidateQueries({ queryKey: keys.admissions(slug) });
    }
  };
}
