/** The names that a step's values can use, asked of the server when a field gets the focus. */
import { useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import { useOpenProgram } from "../../state/context";
import type { LineName } from "./suggestions";

export function useNames(step: string, wanted: boolean): readonly LineName[] {
  const { program, compiled } = useOpenProgram();
  const names = useQuery({
    queryKey: ["expression-names", program.id, step, compiled?.revision ?? 0],
    queryFn: () => api.post<{ names: LineName[] }>(`/programs/${program.id}/expression`, { step, names: true }),
    enabled: wanted,
    placeholderData: (before) => before,
  });
  return names.data?.names ?? [];
}
