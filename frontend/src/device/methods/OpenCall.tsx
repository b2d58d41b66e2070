/** What a device does because somebody told it to by hand: who, what, for how long, and a way to end it. */
import { Button } from "@mantine/core";
import { useMutation, useQuery } from "@tanstack/react-query";
import { Square } from "lucide-react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { mayOperate } from "@/api/roles";
import type { Device, MethodCall, Site } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import styles from "./call.module.css";
import { CallProgress } from "./CallProgress";

const LOOK_MS = 2000;

/**
 * The call by hand that a device carries out. It stands before the device says that it does something, so it is asked
 * for then, and again only while there is one: a device in a run costs one question.
 */
function useOpenCall(site: Site, device: Device): MethodCall | undefined {
  const mine = (calls: MethodCall[] | undefined) => calls?.find((each) => each.device === device.id);
  const isBusy = device.lifecycle === "approved" && ["busy", "waiting"].includes(device.status);
  const calls = useQuery({
    queryKey: ["open-calls", site.slug],
    queryFn: () => api.get<MethodCall[]>(`/sites/${site.slug}/calls`),
    enabled: isBusy,
    refetchInterval: (query) => (mine(query.state.data) ? LOOK_MS : false),
    staleTime: 0,
  });
  return isBusy ? mine(calls.data) : undefined;
}

export function OpenCall({ site, device }: { site: Site; device: Device }) {
  const { t } = useTranslation();
  const call = useOpenCall(site, device);
  const cancel = useMutation({ mutationFn: (id: string) => api.post(`/sites/${site.slug}/calls/${id}/cancel`) });
  if (!call) return null;
  const isEnding = cancel.isPending || (cancel.isSuccess && cancel.variables === call.id);
  return (
    <section className={styles.open} aria-label={t("device.try.openCall")}>
      <div>
        <p>{t("device.try.byHand", { by: call.by, method: call.method })}</p>
        {mayOperate(site.role) ? (
          <Button
            size="compact-sm"
            variant="default"
            loading={isEnding}
            leftSection={<Square size={13} aria-hidden="true" />}
            onClick={() => cancel.mutate(call.id)}
          >
            {t("device.try.cancel")}
          </Button>
        ) : null}
      </div>
      {cancel.isError ? <p role="alert">{problemText(cancel.error, t("shell.problem.screen"))}</p> : null}
      <CallProgress call={call} />
    </section>
  );
}
