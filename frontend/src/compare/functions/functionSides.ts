/** What is read of two versions of a library function. */
import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Comparison, FunctionComparison, LibraryFunction } from "@/api/types";

interface Numbers {
  readonly old: number;
  readonly new: number;
}

export const useFunction = (id: string) =>
  useQuery({
    queryKey: keys.libraryFunction(id, "newest"),
    queryFn: () => api.get<LibraryFunction>(`/library/${id}`),
    staleTime: 0,
  });

/** Both bodies as programs of a site, and how they differ. */
export const useFunctionSides = (site: string, id: string, numbers: Numbers) =>
  useQuery({
    queryKey: keys.libraryFunction(id, "sides", site, numbers.old, numbers.new),
    queryFn: () => api.get<Comparison>(`/library/${id}/sides?site=${site}&old=${numbers.old}&new=${numbers.new}`),
    staleTime: 0,
    placeholderData: keepPreviousData,
  });

/** What is otherwise for who calls it. */
export const useFunctionReasons = (id: string, numbers: Numbers) =>
  useQuery({
    queryKey: keys.libraryFunction(id, "comparison", numbers.old, numbers.new),
    queryFn: () => api.get<FunctionComparison>(`/library/${id}/comparison?old=${numbers.old}&new=${numbers.new}`),
    select: ({ reasons }) => reasons,
    staleTime: Infinity,
  });
