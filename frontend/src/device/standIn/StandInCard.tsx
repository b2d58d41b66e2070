/** Says of a device that it is simulated in place of the real one, and lets operators begin and end that. */
import { Button } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Boxes, Undo2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Device, Site } from "@/api/types";
import { formatPoint } from "@/i18n/format";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import styles from "./standin.module.css";

interface OfDevice {
  site: Site;
  device: Device;
}

/** Switches a device; a refusal stays until the next try, and is told who has left the device by then. */
function useSwitch({ site, device }: OfDevice) {
  const client = useQueryClient();
  const path = `/sites/${site.slug}/devices/${device.id}/stand-in`;
  return useMutation({
    mutationFn: () => (device.stand_in ? api.delete(path) : api.put(path, undefined)),
    onError: useTellUnseen(),
    onSettled: () =>
      Promise.all([
        client.invalidateQueries({ queryKey: keys.devices(site.slug) }),
        client.invalidateQueries({ queryKey: keys.deviceEvents(site.slug, device.id) }),
      ]),
  });
}

export function StandInCard(props: OfDevice) {
  const { t } = useTranslation();
  const { site, device } = props;
  const change = useSwitch(props);
  if (device.lifecycle !== "approved" || (!device.stand_in && !mayOperate(site.role))) return null;
  const on = device.stand_in;
  return (
    <section className={styles.card} data-on={on || undefined} aria-labelledby="stand-in">
      <div className={styles.text}>
        <h3 id="stand-in">{t(on ? "device.standIn.title" : "device.standIn.offer")}</h3>
        <p>{t(on ? "device.standIn.told" : "device.standIn.what")}</p>
        {on && device.stands_at ? (
          <p>{t("device.standIn.stands", { at: formatPoint(device.stands_at.x, device.stands_at.y) })}</p>
        ) : null}
        {on && device.status === "offline" ? <p className={styles.away}>{t("device.standIn.away")}</p> : null}
        {change.isError ? (
          <p role="alert" className={styles.away}>
            {problemText(change.error, t("shell.problem.screen"))}
          </p>
        ) : null}
      </div>
      {mayOperate(site.role) ? (
        <Button
          variant="default"
          size="xs"
          leftSection={on ? <Undo2 size={15} aria-hidden="true" /> : <Boxes size={15} aria-hidden="true" />}
          loading={change.isPending}
          onClick={() => change.mutate()}
        >
          {t(on ? "device.standIn.end" : "device.standIn.begin")}
        </Button>
      ) : null}
    </section>
  );
}
