/** The alerts of one device, or of a run's devices, where people look at them; nothing when all is well. */
import { useRef } from "react";
import { useTranslation } from "react-i18next";
import { useDevices } from "@/api/queries";
import type { Alert } from "@/api/types";
import { StatusGlyph } from "@/design/StatusGlyph";
import { AlertItem } from "./AlertItem";
import { inState, sortAlerts, worstOf } from "./alerts";
import styles from "./alerts.module.css";
import { useAlerts, useMarkSeen } from "./useAlerts";
import { useClock } from "./useClock";
import { signOf } from "./words";

const MOST_IN_BRIEF = 2;

interface DeviceAlertsProps {
  slug: string;
  devices: readonly string[];
  /** In a line each, with the device's name, and only what nobody has seen: over something else. */
  brief?: boolean;
}

export function DeviceAlerts({ slug, devices, brief }: DeviceAlertsProps) {
  const { t } = useTranslation();
  const now = useClock();
  const list = useRef<HTMLUListElement>(null);
  const known = useDevices(slug).data ?? [];
  const { alerts, role } = useAlerts(slug);
  const { one } = useMarkSeen(slug);
  const own = sortAlerts(alerts.filter((alert) => devices.includes(alert.device)));
  const shown = brief ? inState(own, "open") : own;
  if (shown.length === 0) return null;
  const maySee = role !== undefined && role !== "viewer";
  const see = (id: number) => {
    one.mutate(id);
    list.current?.focus();
  };
  return (
    <ul className={styles.own} data-brief={brief} ref={list} tabIndex={-1} aria-label={t("alerts.title")}>
      {shown.slice(0, brief ? MOST_IN_BRIEF : undefined).map((alert) => (
        <AlertItem
          key={alert.id}
          slug={slug}
          alert={alert}
          device={known.find((device) => device.id === alert.device)}
          now={now}
          busy={one.isPending}
          onLeave={brief ? () => undefined : undefined}
          onSeen={maySee ? () => see(alert.id) : undefined}
        />
      ))}
      {brief && shown.length > MOST_IN_BRIEF ? (
        <li className={styles.more}>{t("alerts.more", { count: shown.length - MOST_IN_BRIEF })}</li>
      ) : null}
    </ul>
  );
}

/** The sign that a device in a list has alerts. */
export function AlertMark({ own }: { own: readonly Alert[] | undefined }) {
  const { t } = useTranslation();
  if (!own) return null;
  const worst = worstOf(own);
  if (!worst) return null;
  const words = t("alerts.ofDevice", { count: own.length });
  return (
    <span className={styles.mark} data-severity={worst} title={words}>
      <StatusGlyph status={signOf(worst)} size={13} />
      <span aria-hidden="true">{own.length}</span>
      <span className="visually-hidden">{words}</span>
    </span>
  );
}
