/** What is stopped, who stopped it, and how it goes on. */
import { Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { useDevices } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Device, Site } from "@/api/types";
import { StatusBadge } from "@/design/StatusBadge";
import { activityWords } from "@/i18n/activity";
import { formatMoment } from "@/i18n/format";
import { useAsHeld } from "@/live/held";
import { HoldButton } from "./HoldButton";
import styles from "./stop.module.css";

interface StopDialogProps {
  site: Site;
  opened: boolean;
  busy: boolean;
  onReset: () => void;
  onClose: () => void;
}

function Robots({ devices }: { devices: Device[] }) {
  const { t } = useTranslation();
  return (
    <ul className={styles.robots}>
      {devices.map((device) => (
        <li key={device.id}>
          <strong>{device.name}</strong>
          <StatusBadge status={device.status}>
            {activityWords(device) || t(`shell.status.${device.status}`)}
          </StatusBadge>
        </li>
      ))}
    </ul>
  );
}

export function StopDialog({ site, opened, busy, onReset, onClose }: StopDialogProps) {
  const { t } = useTranslation();
  const devices = useAsHeld(useDevices(opened ? site.slug : undefined).data) ?? [];
  const robots = devices.filter((device) => device.kind === "robot" && device.lifecycle === "approved");
  const { by, at } = site.stop;
  const who = by ?? t("shell.stop.somebody");
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      closeOnClickOutside
      title={t("shell.stop.title", { site: site.name })}
      zIndex={1000}
      size={460}
    >
      <div className={styles.dialog}>
        <p>{at ? t("shell.stop.pressedAt", { who, at: formatMoment(at) }) : t("shell.stop.pressed", { who })}</p>
        <Robots devices={robots} />
        <p className={styles.note}>{t("shell.stop.software")}</p>
        {!mayOperate(site.role) ? (
          <p>{t("shell.stop.askOperator")}</p>
        ) : (
          <HoldButton label={t("shell.stop.reset")} hint={t("shell.stop.holdHint")} disabled={busy} onHeld={onReset} />
        )}
        <p className={styles.after}>{t("shell.stop.after")}</p>
      </div>
    </Modal>
  );
}
