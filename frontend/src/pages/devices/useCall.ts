/** Telling a device to do something, and following what comes of it. */
import { skipToken, useMutation, useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { MethodCall } from "@/api/types";
import type { Argument } from "./arguments";

const FOLLOW_MS = 500;

export interface Order {
  readonly method: string;
  readonly args: Readonly<Record<string, Argument>>;
}

/** `call` is what was asked for last, as it is now; null before. */
export function useCall(slug: string, device: string) {
  const start = useMutation({
    mutationFn: (order: Order) =>
      api.post<MethodCall>(`/sites/${slug}/devices/${encodeURIComponent(device)}/call`, order),
  });
  const path = start.data ? `/sites/${slug}/calls/${start.data.id}` : null;
  const followed = useQuery({
    queryKey: ["call", start.data?.id],
    queryFn: path ? () => api.get<MethodCall>(path) : skipToken,
    refetchInterval: (query) => (query.state.data?.over ? false : FOLLOW_MS),
    staleTime: 0,
  });
  const cancel = useMutation({ mutationFn: () => api.post(`${path}/cancel`) });
  return { start, cancel, call: start.data ? (followed.data ?? start.data) : null };
}
