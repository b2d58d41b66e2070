/** What an admin decides about a device. */
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Device } from "@/api/types";
import { problemText } from "@/app/LoadProblem";

export type Decision = { do: "approve" | "reject"; device: Device } | { do: "rename"; device: Device; name: string };

function send(slug: string, decision: Decision): Promise<Device> {
  const path = `/sites/${slug}/devices/${encodeURIComponent(decision.device.id)}`;
  if (decision.do === "rename") return api.patch<Device>(path, { name: decision.name });
  return api.post<Device>(`${path}/${decision.do}`);
}

export function useDecide(slug: string) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (decision: Decision) => send(slug, decision),
    onSuccess: (_, { do: done, device }) => {
      notifications.show({ message: t(`pages.devices.done.${done}`, { name: device.name }) });
      const changed = [keys.devices(slug), keys.site(slug), keys.sites, keys.deviceEvents(slug, device.id)];
      for (const queryKey of changed) void queries.invalidateQueries({ queryKey });
    },
    onError: (error) =>
      notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")), autoClose: 8000 }),
  });
}
