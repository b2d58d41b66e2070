/** A device's properties as it tells them now. */
import { useTranslation } from "react-i18next";
import type { Device, DeviceProperty } from "@/api/types";
import { StatusBadge } from "@/design/StatusBadge";
import { formatNumber } from "@/i18n/format";
import { unitSign } from "@/i18n/units";
import { useNow } from "../useNow";
import { Sparkline } from "./Sparkline";
import styles from "./detail.module.css";

const COLOURS = ["var(--busy)", "var(--machine)", "var(--brand)", "var(--logic)"];

/** A device that says nothing new for so long is online, but nothing flows. */
const STREAMING_MS = 3000;

function shown({ value, type }: DeviceProperty): string {
  if (typeof value === "number") return formatNumber(value, type === "integer" || Number.isInteger(value) ? 0 : 1);
  return value === null ? "–" : String(value);
}

function PropertyCard({ device, property, colour }: { device: string; property: DeviceProperty; colour: string }) {
  return (
    <li className={styles.property}>
      <code>{property.name}</code>
      <div>
        <span className={styles.value} data-text={typeof property.value === "number" ? undefined : true}>
          {shown(property)}
          <small>{unitSign(property.unit)}</small>
        </span>
        <Sparkline device={device} property={property.name} colour={colour} />
      </div>
    </li>
  );
}

export function LiveProperties({ device }: { device: Device }) {
  const { t } = useTranslation();
  const now = useNow(1000);
  const live = device.status !== "offline";
  const streaming = device.last_seen_at !== null && now - Date.parse(device.last_seen_at) < STREAMING_MS;
  const state = streaming ? "streaming" : "online";
  return (
    <section aria-labelledby="live-properties">
      <div className={styles.sectionHead}>
        <h3 id="live-properties">{t("pages.devices.liveProperties")}</h3>
        <StatusBadge status={live ? "done" : "offline"}>{t(`pages.devices.${live ? state : "lastKnown"}`)}</StatusBadge>
      </div>
      {device.properties.length === 0 ? <p className={styles.none}>{t("pages.devices.noProperties")}</p> : null}
      <ul className={styles.properties}>
        {device.properties.map((property, index) => (
          <PropertyCard
            key={property.name}
            device={device.id}
            property={property}
            colour={COLOURS[index % COLOURS.length] ?? "var(--busy)"}
          />
        ))}
      </ul>
    </section>
  );
}
