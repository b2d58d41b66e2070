/** One alert: what, where, since when, who has seen it. */
import { Button } from "@mantine/core";
import { Crosshair } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { Alert, Device } from "@/api/types";
import { StatusGlyph } from "@/design/StatusGlyph";
import { formatAgo, formatMoment } from "@/i18n/format";
import styles from "./alerts.module.css";
import { alertWords, ownWords, signOf } from "./alertWords";

interface AlertItemProps {
  slug: string;
  alert: Alert;
  /** The device as it is known; a pending device that VIPO does not understand is none yet. */
  device: Device | undefined;
  now: number;
  /** Left out where the device is the page's own. */
  onLeave?: () => void;
  onSeen?: () => void;
  busy: boolean;
}

function Where({ slug, alert, device, onLeave }: Pick<AlertItemProps, "slug" | "alert" | "device" | "onLeave">) {
  const { t } = useTranslation();
  if (!device) return <b className={styles.device}>{alert.device}</b>;
  return (
    <>
      <Link className={styles.device} to={`/sites/${slug}/devices/${alert.device}`} onClick={onLeave}>
        {device.name}
      </Link>
      <Link
        className={styles.jump}
        to={`/sites/${slug}/map?device=${alert.device}`}
        onClick={onLeave}
        aria-label={t("alerts.onMap", { device: device.name })}
        title={t("alerts.onMap", { device: device.name })}
      >
        <Crosshair size={14} aria-hidden="true" />
      </Link>
    </>
  );
}

function useFacts({ alert, now }: AlertItemProps): string[] {
  const { t } = useTranslation();
  const time = alert.over_at
    ? t("alerts.overSince", { ago: formatAgo(alert.over_at, now) })
    : formatAgo(alert.count > 1 ? alert.last_at : alert.first_at, now);
  const times = alert.count > 1 ? t("alerts.times", { count: alert.count }) : "";
  const seen = alert.seen_by ? t("alerts.seenBy", { name: alert.seen_by }) : "";
  return [time, times, seen].filter(Boolean);
}

export function AlertItem(props: AlertItemProps) {
  const { t } = useTranslation();
  const { slug, alert, device, onLeave, onSeen, busy } = props;
  const facts = useFacts(props);
  return (
    <li className={styles.item} data-severity={alert.severity} data-state={alert.state}>
      <StatusGlyph status={signOf(alert.severity)} size={16} />
      <div className={styles.body}>
        <p className={styles.what}>
          <span className="visually-hidden">{t(`alerts.severity.${alert.severity}`)}: </span>
          {onLeave ? <Where {...{ slug, alert, device, onLeave }} /> : null}
          <span className={styles.words}>{alertWords(alert)}</span>
        </p>
        {ownWords(alert) ? <p className={styles.why}>{ownWords(alert)}</p> : null}
        <p className={styles.facts} title={formatMoment(alert.first_at)}>
          {facts.join(" · ")}
        </p>
      </div>
      {onSeen && alert.state === "open" ? (
        <Button
          size="compact-sm"
          variant="default"
          disabled={busy}
          onClick={onSeen}
          aria-label={t("alerts.seenOf", { device: device?.name ?? alert.device, what: alertWords(alert) })}
        >
          {t("alerts.seen")}
        </Button>
      ) : null}
    </li>
  );
}
