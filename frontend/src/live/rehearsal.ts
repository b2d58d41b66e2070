/** A rehearsal as it stands. */
import { skipToken, useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { api, untilRefused } from "@/api/client";
import { missing } from "@/api/failed";
import { keys, type Maybe } from "@/api/queries";
import type { Rehearsal } from "@/api/types";
import { isOver } from "./messages";

const unlessRefused = untilRefused(1000);

/** Ask for the rehearsal again until it is over; the live socket is faster, this holds when it is away. */
export const useFreshRehearsal = (id: Maybe) =>
  useQuery({
    queryKey: keys.rehearsal(id ?? ""),
    queryFn: id ? () => api.get<Rehearsal>(`/rehearsals/${encodeURIComponent(id)}`) : skipToken,
    refetchInterval: (query) => {
      const { data } = query.state;
      return data && isOver(data.status) ? false : unlessRefused(query);
    },
    refetchIntervalInBackground: true,
  });

/** Why a rehearsal is not known, also while it is asked for once more: what is said of it and can be done stays. */
export function useWhyUnknown(id: Maybe, rehearsal: ReturnType<typeof useFreshRehearsal>): string | undefined {
  const [last, setLast] = useState<{ id: Maybe; why: string }>();
  const why = missing(rehearsal)?.message;
  if (why !== undefined && (last?.id !== id || last?.why !== why)) setLast({ id, why });
  return why ?? (rehearsal.data || last?.id !== id ? undefined : last?.why);
}
