/** What an admin decides about a device. */
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Device } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { formatNumber } from "@/i18n/format";
import { useShownKeys, type ShownKey } from "./keys/shownKey";

export type Decision =
  | { do: "approve" | "reject" | "retire" | "readmit" | "rotate" | "revoke"; device: Device }
  | { do: "confirmTopic" | "withdrawTopic"; device: Device; topic: string }
  | { do: "rename"; device: Device; name: string }
  | { do: "move"; device: Device; to: readonly [number, number] }
  | { do: "ownPlace"; device: Device };

/** What the server answers that is told only once. */
interface Told {
  credential?: string | null;
  taken?: boolean;
}

function send(slug: string, decision: Decision): Promise<Told> {
  const path = `/sites/${slug}/devices/${encodeURIComponent(decision.device.id)}`;
  switch (decision.do) {
    case "rename":
      return api.patch<Told>(path, { name: decision.name });
    case "move": {
      const [x, y] = decision.to;
      return api.patch<Told>(path, { location: { ...decision.device.location, x, y } });
    }
    case "ownPlace":
      return api.patch<Told>(path, { location: null });
    case "confirmTopic":
      return api.post<Told>(`${path}/topics/confirm`, { topic: decision.topic });
    case "withdrawTopic":
      return api.post<Told>(`${path}/topics/withdraw`, { topic: decision.topic });
    case "rotate":
      return api.post<Told>(`${path}/credential`);
    case "revoke":
      return api.delete<Told>(`${path}/credential`);
    default:
      return api.post<Told>(`${path}/${decision.do}`);
  }
}

const show = (key: ShownKey) => useShownKeys.setState((all) => [...all, key], true);

/** Decide about a device. Decisions, as moves on the map, go out one after another. */
export function useDecide(slug: string) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  return useMutation({
    scope: { id: `places ${slug}` },
    mutationFn: (decision: Decision) => send(slug, decision),
    onSuccess: ({ credential, taken = false }, decision) => {
      const { device } = decision;
      if (credential) show({ device: device.id, name: device.name, credential, taken });
      notifications.show({ message: doneText(t, decision) });
      const changed = [
        keys.devices(slug),
        keys.site(slug),
        keys.sites,
        keys.deviceEvents(slug, device.id),
        keys.rdf(slug, device.id),
      ];
      for (const queryKey of changed) void queries.invalidateQueries({ queryKey });
    },
    onError: (error) =>
      notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")), autoClose: 8000 }),
  });
}

function doneText(t: ReturnType<typeof useTranslation>["t"], decision: Decision): string {
  const { name } = decision.device;
  switch (decision.do) {
    case "approve":
    case "reject":
    case "rename":
      return t(`pages.devices.done.${decision.do}`, { name });
    case "move":
      return t("keys.done.move", { name, x: formatNumber(decision.to[0], 2), y: formatNumber(decision.to[1], 2) });
    case "confirmTopic":
    case "withdrawTopic":
      return t(`device.topic.done.${decision.do}`, { name, topic: decision.topic });
    default:
      return t(`keys.done.${decision.do}`, { name });
  }
}
