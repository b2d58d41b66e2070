/** A device's properties as it tells them now. */
import { SegmentedControl } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Device, DeviceProperty, Site } from "@/api/types";
import { StatusBadge } from "@/design/StatusBadge";
import { formatReading } from "@/i18n/format";
import { unitSign } from "@/i18n/units";
import { useNow } from "@/design/useNow";
import { isOnline } from "../online";
import { Sparkline } from "./Sparkline";
import { RANGES, type Range } from "./useHistory";
import styles from "./readings.module.css";

const COLOURS = ["var(--busy)", "var(--machine)", "var(--brand)", "var(--logic)"];

/** A device that says nothing new for so long is online, but nothing flows. */
const STREAMING_MS = 3000;

function shown({ value }: DeviceProperty): string {
  if (typeof value === "number") return formatReading(value);
  return value === null || value === "" ? "–" : String(value);
}

interface PropertyCardProps {
  slug: string;
  device: string;
  property: DeviceProperty;
  range: Range;
  colour: string;
}

function PropertyCard({ slug, device, property, range, colour }: PropertyCardProps) {
  return (
    <li className={styles.property}>
      <code title={property.name}>{property.name}</code>
      <div>
        <span
          className={styles.value}
          data-text={typeof property.value === "number" ? undefined : true}
          title={typeof property.value === "string" ? property.value : undefined}
        >
          {shown(property)}
          <small>{unitSign(property.unit)}</small>
        </span>
        <Sparkline slug={slug} device={device} property={property.name} range={range} colour={colour} />
      </div>
    </li>
  );
}

function RangeChoice({ range, choose }: { range: Range; choose: (range: Range) => void }) {
  const { t } = useTranslation();
  return (
    <SegmentedControl
      size="xs"
      aria-label={t("device.history.choose")}
      data={RANGES.map((value) => ({ value, label: t(`device.history.${value}`) }))}
      value={range}
      onChange={(value) => choose(value)}
    />
  );
}

export function LiveProperties({ site, device }: { site: Site; device: Device }) {
  const { t } = useTranslation();
  const [range, setRange] = useState<Range>("now");
  const now = useNow(1000);
  const live = isOnline(device, now);
  const streaming = device.last_seen_at !== null && now - Date.parse(device.last_seen_at) < STREAMING_MS;
  const state = streaming ? "streaming" : "online";
  return (
    <section aria-labelledby="live-properties">
      <div className={styles.sectionHead}>
        <h3 id="live-properties">{t("pages.devices.liveProperties")}</h3>
        {device.properties.length > 0 ? <RangeChoice range={range} choose={setRange} /> : null}
        <StatusBadge status={live ? "done" : "offline"}>{t(`pages.devices.${live ? state : "lastKnown"}`)}</StatusBadge>
      </div>
      {device.properties.length === 0 ? <p className={styles.none}>{t("pages.devices.noProperties")}</p> : null}
      <ul className={styles.properties}>
        {device.properties.map((property, index) => (
          <PropertyCard
            key={property.name}
            slug={site.slug}
            device={device.id}
            property={property}
            range={range}
            colour={COLOURS[index % COLOURS.length] ?? "var(--busy)"}
          />
        ))}
      </ul>
    </section>
  );
}
