import { BatteryLow, BatteryMedium, BatteryFull } from "lucide-react";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { Alert, Device } from "@/api/types";
import { byDevice } from "@/shell/alerts/alerts";
import { AlertMark } from "@/shell/alerts/DeviceAlerts";
import { useAlerts } from "@/shell/alerts/useAlerts";
import { StatusBadge } from "@/design/StatusBadge";
import { activityWords } from "@/i18n/activity";
import { formatAge, formatNumber, formatPoint, withUnit } from "@/i18n/format";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import pages from "../pages.module.css";
import { useNow } from "@/design/useNow";
import { batteryOf } from "./filter";
import { rowId } from "./focus";
import styles from "./devices.module.css";

const COLUMN_CLASSES: Readonly<Record<string, string | undefined>> = {
  position: pages.optional,
  battery: styles.right,
};

function Battery({ device }: { device: Device }) {
  const percent = batteryOf(device);
  if (percent === null) return null;
  const Icon = percent < 20 ? BatteryLow : percent < 70 ? BatteryMedium : BatteryFull;
  return (
    <span className={styles.battery} data-low={percent < 20 || undefined}>
      <Icon size={17} aria-hidden="true" />
      {withUnit(formatNumber(percent), "%")}
    </span>
  );
}

interface RowProps {
  device: Device;
  alerts: readonly Alert[] | undefined;
  slug: string;
  chosen: boolean;
  now: number;
}

function Row({ device, alerts, slug, chosen, now }: RowProps) {
  const { t } = useTranslation();
  const { x, y } = device.location;
  return (
    <tr data-status={device.status} aria-selected={chosen} className={styles.row}>
      <td className={styles.name}>
        <Link id={rowId(device.id)} to={`/sites/${slug}/devices/${device.id}`} className={styles.device}>
          <span className={styles.disc} data-status={device.status}>
            <DeviceIcon deviceClass={device.device_class} size={17} />
          </span>
          <span>
            <b title={device.name}>{device.name}</b>
            <code>{device.id}</code>
          </span>
        </Link>
      </td>
      <td>
        <StatusBadge status={device.status}>{t(`shell.status.${device.status}`)}</StatusBadge>
        <AlertMark own={alerts} />
      </td>
      <td className={styles.doing} title={activityWords(device)}>
        {device.status === "pending" ? t("pages.devices.notTrusted") : activityWords(device) || "–"}
      </td>
      <td className={pages.optional}>
        <code className={styles.position}>{formatPoint(x, y)}</code>
      </td>
      <td>{device.last_seen_at ? formatAge(device.last_seen_at, now) : t("pages.devices.never")}</td>
      <td className={styles.right}>
        <Battery device={device} />
      </td>
    </tr>
  );
}

export function DeviceTable({
  devices,
  slug,
  chosen,
}: {
  devices: Device[];
  slug: string;
  chosen: string | undefined;
}) {
  const { t } = useTranslation();
  const now = useNow(1000);
  const { alerts } = useAlerts(slug);
  const alertsOf = useMemo(() => byDevice(alerts), [alerts]);
  return (
    <div className={pages.scroll}>
      <table className={`${pages.table} ${styles.compact}`}>
        <thead>
          <tr>
            {["device", "status", "doing", "position", "lastSeen", "battery"].map((column) => (
              <th key={column} scope="col" className={COLUMN_CLASSES[column]}>
                {t(`pages.devices.column.${column}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {devices.map((device) => (
            <Row
              key={device.id}
              device={device}
              alerts={alertsOf.get(device.id)}
              slug={slug}
              chosen={device.id === chosen}
              now={now}
            />
          ))}
        </tbody>
      </table>
    </div>
  );
}
