/** A rehearsal as it stands. */
import { useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { keys, useRehearsal } from "@/api/queries";
import { isOver } from "./messages";

const POLL_MS = 1000;

/** Ask for the rehearsal again until it is over; the live socket is faster, this holds when it is away. */
export function useFreshRehearsal(id: string | undefined) {
  const query = useRehearsal(id);
  const queries = useQueryClient();
  const status = query.data?.status;
  useEffect(() => {
    if (!id || (status && isOver(status))) return;
    const timer = setInterval(() => void queries.invalidateQueries({ queryKey: keys.rehearsal(id) }), POLL_MS);
    return () => clearInterval(timer);
  }, [id, status, queries]);
  return query;
}
