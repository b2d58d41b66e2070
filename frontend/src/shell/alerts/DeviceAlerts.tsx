/** The alerts of one device, or of a run's devices, where people look at them; nothing when all is well. */
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useDevices } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Alert } from "@/api/types";
import { useNow } from "@/design/useNow";
import { StatusGlyph } from "@/design/StatusGlyph";
import { AlertItem } from "./AlertItem";
import { inState, sortAlerts, worstOf } from "./alerts";
import styles from "./alerts.module.css";
import { useAlerts, useMarkSeen } from "./useAlerts";
import { signOf } from "./alertWords";

const MOST_IN_BRIEF = 2;

interface DeviceAlertsProps {
  slug: string;
  devices: readonly string[];
  /** In a line each, with the device's name, and only what nobody has seen: over something else. */
  brief?: boolean;
}

export function DeviceAlerts({ slug, devices, brief }: DeviceAlertsProps) {
  const { t } = useTranslation();
  const box = useRef<HTMLDivElement>(null);
  // Whoever marks the last one as seen goes on from where it was by keyboard.
  const [left, setLeft] = useState(false);
  const { alerts } = useAlerts(slug);
  const own = sortAlerts(alerts.filter((alert) => devices.includes(alert.device)));
  const shown = brief ? inState(own, "open") : own;
  const none = shown.length === 0;
  if (none && !left) return null;
  const stay = () => {
    box.current?.focus();
    setLeft(true);
  };
  return (
    <div
      ref={box}
      tabIndex={-1}
      className={none ? "visually-hidden" : styles.around}
      onBlur={none ? () => setLeft(false) : undefined}
    >
      {none ? t("alerts.none.open") : <List slug={slug} alerts={shown} brief={brief} onSeen={stay} />}
    </div>
  );
}

interface ListProps {
  slug: string;
  alerts: readonly Alert[];
  brief: boolean | undefined;
  /** Called when the button that has the focus is about to go. */
  onSeen: () => void;
}

function List({ slug, alerts, brief, onSeen }: ListProps) {
  const { t } = useTranslation();
  const now = useNow(10_000);
  const known = useDevices(slug).data ?? [];
  const { role } = useAlerts(slug);
  const { one } = useMarkSeen(slug);
  const maySee = mayOperate(role);
  const see = (id: number) => {
    one.mutate(id);
    onSeen();
  };
  return (
    <ul className={styles.own} data-brief={brief} aria-label={t("alerts.title")}>
      {alerts.slice(0, brief ? MOST_IN_BRIEF : undefined).map((alert) => (
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
      {brief && alerts.length > MOST_IN_BRIEF ? (
        <li className={styles.more}>{t("alerts.more", { count: alerts.length - MOST_IN_BRIEF })}</li>
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
