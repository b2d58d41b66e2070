/** A site's alerts, as far as they concern the reader, and saying that one has seen them. */
import { notifications } from "@mantine/notifications";
import { skipToken, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys, useSite } from "@/api/queries";
import type { Alert } from "@/api/types";
import { applyAlert } from "@/live/alerts";
import { problemText } from "../LoadProblem";
import { concerns } from "./alerts";

const NONE: Alert[] = [];

/** The alerts that are not over. */
export function useAlerts(slug: string | undefined) {
  const role = useSite(slug).data?.role;
  const query = useQuery({
    queryKey: keys.alerts(slug ?? ""),
    queryFn: slug ? () => api.all<Alert>(`/sites/${encodeURIComponent(slug)}/alerts`) : skipToken,
  });
  const all = query.data ?? NONE;
  const alerts = useMemo(() => all.filter((alert) => concerns(alert, role)), [all, role]);
  return { alerts, role, query };
}

/** The alerts that are over, fetched when they are asked for. */
export function useOverAlerts(slug: string, wanted: boolean) {
  return useQuery({
    queryKey: keys.overAlerts(slug),
    queryFn: wanted ? () => api.all<Alert>(`/sites/${encodeURIComponent(slug)}/alerts?state=over`) : skipToken,
  });
}

export function useMarkSeen(slug: string) {
  const queries = useQueryClient();
  const { t } = useTranslation();
  const key = keys.alerts(slug);
  const onError = (error: Error) =>
    notifications.show({ message: problemText(error, t("alerts.notKept")), color: "red", autoClose: 8000 });
  const one = useMutation({
    mutationFn: (id: number) => api.post<Alert>(`/alerts/${id}/seen`),
    onSuccess: (alert) => queries.setQueryData<Alert[]>(key, (all) => applyAlert(all ?? [], alert)),
    onError,
  });
  const every = useMutation({
    mutationFn: () => api.post<Alert[]>(`/sites/${encodeURIComponent(slug)}/alerts/seen`),
    onSuccess: (alerts) => queries.setQueryData<Alert[]>(key, alerts),
    onError,
  });
  return { one, every };
}
