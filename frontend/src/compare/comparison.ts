/** What is asked of the server to compare two states of a program. */
import { keepPreviousData, skipToken, useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import { keys, type Maybe, useGet } from "@/api/queries";
import type { Comparison, RunSummary } from "@/api/types";

const RUNS_OF_A_PROGRAM = 200;

/** The newest runs of one program, each with the version that it used. */
export const useProgramRuns = (slug: Maybe, program: Maybe) =>
  useGet<RunSummary[]>(
    [...keys.runs(slug ?? ""), "of", program],
    slug && program ? `/sites/${slug}/runs?program=${encodeURIComponent(program)}&limit=${RUNS_OF_A_PROGRAM}` : null,
  );

/** Two sides compared: numbers of versions, or `draft` for what is drawn now. */
export const useComparison = (id: Maybe, sides: readonly [old: string, new: string] | null) =>
  useQuery({
    queryKey: [...keys.comparison(id ?? ""), ...(sides ?? [])],
    queryFn:
      id && sides ? () => api.get<Comparison>(`/programs/${id}/comparison?old=${sides[0]}&new=${sides[1]}`) : skipToken,
    staleTime: 0,
    placeholderData: keepPreviousData,
  });
