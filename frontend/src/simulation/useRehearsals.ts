/** What of a site is rehearsed, and how a rehearsal is started and cancelled. */
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { useLocation, useNavigate } from "react-router-dom";
import { api, ApiProblem } from "@/api/client";
import { useOnce } from "@/api/once";
import { keys, useRehearsals } from "@/api/queries";
import type { Rehearsal } from "@/api/types";

const LIST_MS = 2000;

/** What of the site is not over, as long as it is looked at: places move whenever any rehearsal ends. */
export function useOpenRehearsals(site: string | undefined) {
  const query = useRehearsals(site);
  const queries = useQueryClient();
  useEffect(() => {
    if (!site) return;
    const look = () => void queries.invalidateQueries({ queryKey: keys.rehearsals(site) });
    look();
    const timer = setInterval(look, LIST_MS);
    return () => clearInterval(timer);
  }, [site, queries]);
  return query.data ?? [];
}

/** Why the editor was refused, where it has led here to say so. */
function useRefusalOfEditor(): string | undefined {
  const state: unknown = useLocation().state;
  const told = typeof state === "object" && state !== null && "refusal" in state ? state.refusal : undefined;
  return typeof told === "string" ? told : undefined;
}

/** Rehearse the program as it is drawn now; under the conditions of `last`, where there was one. */
export function useStartRehearsal(program: string, last?: Rehearsal) {
  const navigate = useNavigate();
  const told = useRefusalOfEditor();
  const begin = useOnce();
  const starting = useMutation({
    mutationFn: () => begin<{ id: string }>(`/programs/${program}/rehearsals`, againAs(last?.asked)),
    onSuccess: ({ id }) => void navigate(`/programs/${program}/simulate/${id}`, { replace: true }),
  });
  const refused = starting.error instanceof ApiProblem ? starting.error.detail : undefined;
  return { start: () => starting.mutate(), problem: refused ?? (starting.isIdle ? told : undefined) };
}

function againAs(asked: Rehearsal["asked"] | undefined) {
  if (!asked) return {};
  const { seed, driver, parameters, faults } = asked;
  return { seed, driver, parameters, faults: { version: 1, faults } };
}

/** Cancel a rehearsal; one that has ended meanwhile is shown as it is. */
export function useCancelRehearsal(site: string | undefined) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => api.post(`/rehearsals/${id}/cancel`),
    onSettled: (_data, _error, id) =>
      Promise.all([
        queries.invalidateQueries({ queryKey: keys.rehearsal(id) }),
        queries.invalidateQueries({ queryKey: keys.rehearsals(site ?? "") }),
      ]),
  });
}
