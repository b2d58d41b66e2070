/** Everything that is known about one device. */
import { Menu, Tabs } from "@mantine/core";
import { Crosshair, Ellipsis, MapPin, Pencil, X } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate } from "react-router-dom";
import type { Device, Site } from "@/api/types";
import { DeviceAlerts } from "@/shell/alerts/DeviceAlerts";
import { Chip } from "@/design/Chip";
import { IconButton } from "@/design/IconButton";
import { StatusBadge } from "@/design/StatusBadge";
import { statusColour } from "@/design/StatusGlyph";
import { doingWords } from "@/i18n/activity";
import { formatAge, formatNumber } from "@/i18n/format";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { useNow } from "@/design/useNow";
import { DeviceHistory } from "@/device/history/DeviceHistory";
import { useDecide } from "./decisions";
import { DescriptionTable } from "./description/DescriptionTable";
import { jobOf } from "./filter";
import { useFocusInList } from "./focus";
import { AskKeyDecision, KeyMenuItems, KeyTrouble, type KeyDecision } from "./keys/KeyActions";
import { OpenCall } from "@/device/methods/OpenCall";
import { StandInCard } from "@/device/standIn/StandInCard";
import { StandInMark } from "@/device/standIn/StandInMark";
import { MeasuredTimes } from "@/device/paces/MeasuredTimes";
import { LiveProperties } from "@/device/readings/LiveProperties";
import { Methods } from "./methods/Methods";
import { RdfSource } from "./description/RdfSource";
import { RenameDevice } from "./RenameDevice";
import { RobotMapCard } from "./robotMap/RobotMapCard";
import { UsedIn, useUsedIn } from "./UsedIn";
import styles from "./detail.module.css";

function Ring({ device }: { device: Device }) {
  const job = jobOf(device);
  const colour = statusColour(device.status);
  return (
    <span className={styles.ring}>
      <svg viewBox="0 0 48 48" width={48} height={48} aria-hidden="true">
        <circle
          cx={24}
          cy={24}
          r={21.5}
          fill="none"
          stroke={colour}
          strokeWidth={job === null ? 2 : 3.4}
          opacity={job === null ? 1 : 0.25}
        />
        {job === null ? null : (
          <circle
            cx={24}
            cy={24}
            r={21.5}
            fill="none"
            stroke={colour}
            strokeWidth={3.4}
            pathLength={100}
            strokeDasharray={`${job * 100} 100`}
            transform="rotate(-90 24 24)"
          />
        )}
      </svg>
      <DeviceIcon deviceClass={device.device_class} size={22} />
    </span>
  );
}

function Heading({ device }: { device: Device }) {
  const { t } = useTranslation();
  const now = useNow(1000);
  const [word, doing] = [t(`shell.status.${device.status}`), doingWords(device)];
  return (
    <div className={styles.heading}>
      <h2>{device.name}</h2>
      <p>
        <StatusBadge status={device.status}>
          {doing && device.status !== "pending" ? `${word}: ${doing}` : word}
        </StatusBadge>
        {device.stand_in ? <StandInMark /> : null}
        {device.last_seen_at ? (
          <span>{t("pages.devices.seen", { age: formatAge(device.last_seen_at, now) })}</span>
        ) : null}
      </p>
    </div>
  );
}

function Overview({ site, device }: { site: Site; device: Device }) {
  return (
    <div className={styles.overview}>
      <DeviceAlerts slug={site.slug} devices={[device.id]} />
      {device.description ? <p>{device.description}</p> : null}
      <KeyTrouble device={device} />
      <StandInCard site={site} device={device} />
      <OpenCall site={site} device={device} />
      <LiveProperties site={site} device={device} />
      {device.kind === "robot" && device.lifecycle === "approved" ? <RobotMapCard site={site} device={device} /> : null}
      <Methods site={site} device={device} />
      {device.lifecycle === "approved" ? <MeasuredTimes site={site} device={device} /> : null}
      <div className={styles.pair}>
        <RdfSource slug={site.slug} device={device.id} />
        <DeviceHistory slug={site.slug} device={device.id} most={6} />
      </div>
    </div>
  );
}

function Actions({ site, device }: { site: Site; device: Device }) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const [renaming, setRenaming] = useState(false);
  const [asking, setAsking] = useState<KeyDecision | null>(null);
  const decide = useDecide(site.slug);
  return (
    <div className={styles.actions}>
      <IconButton
        label={t("pages.devices.onMap")}
        onClick={() => void navigate(`/sites/${site.slug}/map?device=${device.id}`)}
      >
        <Crosshair size={17} aria-hidden="true" />
      </IconButton>
      {site.role === "admin" ? (
        <Menu position="bottom-end" width={180}>
          <Menu.Target>
            <IconButton label={t("pages.more")}>
              <Ellipsis size={17} aria-hidden="true" />
            </IconButton>
          </Menu.Target>
          <Menu.Dropdown>
            <Menu.Item leftSection={<Pencil size={15} />} onClick={() => setRenaming(true)}>
              {t("pages.devices.rename")}
            </Menu.Item>
            {device.kind === "machine" && device.is_placed ? (
              <Menu.Item leftSection={<MapPin size={15} />} onClick={() => decide.mutate({ do: "ownPlace", device })}>
                {t("pages.devices.ownPlace")}
              </Menu.Item>
            ) : null}
            <KeyMenuItems device={device} choose={setAsking} />
          </Menu.Dropdown>
        </Menu>
      ) : null}
      <Link to={`/sites/${site.slug}/devices`} aria-label={t("pages.close")} className={styles.close}>
        <X size={18} aria-hidden="true" />
      </Link>
      {asking ? <AskKeyDecision site={site} device={device} decision={asking} onClose={() => setAsking(null)} /> : null}
      {renaming ? <RenameDevice site={site} device={device} onClose={() => setRenaming(false)} /> : null}
    </div>
  );
}

export function DeviceDetail({ site, device }: { site: Site; device: Device }) {
  const { t } = useTranslation();
  const uses = useUsedIn(site.slug, device.id).found?.length ?? 0;
  useFocusInList(device.id);
  return (
    <aside className={styles.detail} aria-label={device.name}>
      <header className={styles.head}>
        <Ring device={device} />
        <Heading device={device} />
        <Actions site={site} device={device} />
      </header>
      <Tabs defaultValue="overview" className={styles.tabs} keepMounted={false}>
        <Tabs.List>
          <Tabs.Tab value="overview">{t("pages.devices.tab.overview")}</Tabs.Tab>
          <Tabs.Tab value="rdf">{t("pages.devices.rdf")}</Tabs.Tab>
          <Tabs.Tab value="history">{t("pages.devices.tab.history")}</Tabs.Tab>
          <Tabs.Tab value="used" rightSection={uses > 0 ? <Chip>{formatNumber(uses)}</Chip> : null}>
            {t("adding.usedIn")}
          </Tabs.Tab>
        </Tabs.List>
        <Tabs.Panel value="overview">
          <Overview site={site} device={device} />
        </Tabs.Panel>
        <Tabs.Panel value="rdf" className={styles.whole}>
          <DescriptionTable device={device} />
          <RdfSource slug={site.slug} device={device.id} />
        </Tabs.Panel>
        <Tabs.Panel value="history" className={styles.whole}>
          <DeviceHistory slug={site.slug} device={device.id} most={200} />
        </Tabs.Panel>
        <Tabs.Panel value="used" className={styles.whole}>
          <UsedIn slug={site.slug} device={device.id} />
        </Tabs.Panel>
      </Tabs>
    </aside>
  );
}
