/** How long a program mostly takes, by the runs of it that ended well. */
import { useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { Run, RunSummary } from "@/api/types";

type Ended = Pick<RunSummary, "status" | "version" | "started_at" | "ended_at">;

/** So many of the last runs are looked at. */
const LOOKED_AT = 20;

/**
 * The middle of what these runs took, seconds: of those with the same version, or, where there is none of it yet, of all.
 * Null where no run has ended well.
 */
export function usualSeconds(runs: readonly Ended[], version: number): number | null {
  const done = runs.filter(({ status }) => status === "finished");
  const same = done.filter((run) => run.version === version);
  const taken = (same.length > 0 ? same : done)
    .flatMap(({ started_at, ended_at }) => (started_at && ended_at ? [spanOf(started_at, ended_at)] : []))
    .sort((a, b) => a - b);
  return taken[Math.floor(taken.length / 2)] ?? null;
}

function spanOf(from: string, to: string): number {
  return (Date.parse(to) - Date.parse(from)) / 1000;
}

/** What a run that is under way will mostly take, by those before it; null where nobody knows. */
export function useUsualTime({ id, site, program, version }: Run, isOver: boolean): number | null {
  const path = `/sites/${encodeURIComponent(site)}/runs?program=${program.id}&state=finished&limit=${LOOKED_AT}`;
  const before = useQuery({
    queryKey: ["usual-time", id],
    queryFn: () => api.get<RunSummary[]>(path),
    enabled: !isOver,
    staleTime: Infinity,
  });
  return isOver ? null : usualSeconds(before.data ?? [], version);
}
