/** A machine or robot beside the map: how it is now, what it can do and was doing, and the steps that use it. */
import { Button } from "@mantine/core";
import { ExternalLink, ListPlus, X } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices } from "@/api/queries";
import type { Device } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { StatusBadge } from "@/design/StatusBadge";
import { useNow } from "@/design/useNow";
import { DeviceHistory } from "@/device/history/DeviceHistory";
import { OpenCall } from "@/device/methods/OpenCall";
import { TryButton } from "@/device/methods/TryButton";
import { LiveProperties } from "@/device/readings/LiveProperties";
import { activityWords } from "@/i18n/activity";
import { formatAge } from "@/i18n/format";
import { useAsHeld } from "@/live/held";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { chipLabel } from "@/program/scene/announcements";
import { DeviceAlerts } from "@/shell/alerts/DeviceAlerts";
import { selection } from "../commands/command";
import { runCommand } from "../commands/keys";
import { commandOf } from "../commands/table";
import { showSteps } from "../commands/view";
import { sortByReading } from "../edits/clipping";
import { usesOf } from "../edits/uses";
import { useOpenProgram } from "../state/context";
import { focusMap } from "../state/focus";
import { select, useUi } from "../state/ui";
import { Section } from "./fields/FieldFrame";
import classes from "../panel.module.css";
import styles from "./device.module.css";

const EVENTS = 6;

function close(): void {
  useUi.setState({ device: null });
  focusMap();
}

export function DevicePanel({ id }: { id: string }) {
  const { site, t } = useOpenProgram();
  // As it is now: what the drawing knows of devices changes only with what is drawn.
  const device = useAsHeld(useDevices(site.slug).data)?.find((each) => each.id === id);
  return (
    <aside className={classes.panel} aria-label={t("device_panel.label")}>
      <header className={classes.head}>
        <span className={classes.icon} style={{ color: "var(--machine)", background: "var(--machine-soft)" }}>
          <DeviceIcon deviceClass={device?.device_class ?? ""} size={20} />
        </span>
        <span className={classes.title}>
          <h2>{device?.name ?? id}</h2>
          {device ? <State device={device} /> : null}
        </span>
        <IconButton label={t("inspector.close")} onClick={close}>
          <X size={17} aria-hidden="true" />
        </IconButton>
      </header>
      <div className={classes.body}>{device ? <Body device={device} /> : <p>{t("device_panel.gone")}</p>}</div>
    </aside>
  );
}

function State({ device }: { device: Device }) {
  const now = useNow(1000);
  const { t } = useTranslation();
  const doing = activityWords(device);
  const seen = device.last_seen_at ? t("pages.devices.seen", { age: formatAge(device.last_seen_at, now) }) : "";
  return (
    <span className={styles.state}>
      <StatusBadge status={device.status}>{doing || t(`shell.status.${device.status}`)}</StatusBadge>
      <span>{seen}</span>
    </span>
  );
}

function Body({ device }: { device: Device }) {
  const { site, t } = useOpenProgram();
  return (
    <>
      <Image device={device} />
      <DeviceAlerts slug={site.slug} devices={[device.id]} />
      {device.description ? <p className={classes.now}>{device.description}</p> : null}
      <OpenCall site={site} device={device} />
      <div className={styles.readings}>
        <LiveProperties site={site} device={device} />
      </div>
      <Methods device={device} />
      <Uses device={device} />
      <DeviceHistory slug={site.slug} device={device.id} most={EVENTS} />
      <Link to={`/sites/${site.slug}/devices/${device.id}`} className={styles.page}>
        <ExternalLink size={14} aria-hidden="true" />
        {t("device_panel.page")}
      </Link>
    </>
  );
}

/** What the device says it looks like; nothing where the address leads nowhere. */
function Image({ device }: { device: Device }) {
  const { t } = useOpenProgram();
  const [broken, setBroken] = useState("");
  if (!device.image || broken === device.image) return null;
  return (
    <img
      className={styles.image}
      src={device.image}
      alt={t("device_panel.image", { name: device.name })}
      referrerPolicy="no-referrer"
      onError={() => setBroken(device.image)}
    />
  );
}

function Methods({ device }: { device: Device }) {
  const { site, t, canEdit } = useOpenProgram();
  const open = useOpenProgram();
  const add = commandOf("quick_add");
  return (
    <Section title={t("device_panel.methods")}>
      {device.methods.length === 0 ? <p className={classes.now}>{t("device_panel.no_methods")}</p> : null}
      <ul className={styles.methods}>
        {device.methods.map((method) => (
          <li key={method.name}>
            <span>
              <code>{method.name}</code>
              {method.title && method.title !== method.name ? <small>{method.title}</small> : null}
            </span>
            {device.lifecycle === "approved" ? <TryButton site={site} device={device} method={method} /> : null}
          </li>
        ))}
      </ul>
      {canEdit ? (
        <Button
          variant="default"
          leftSection={<ListPlus size={16} aria-hidden="true" />}
          onClick={() => runCommand(open, add, { ...selection(), device: device.id, at: placeOf(device) })}
        >
          {t("device_panel.add")}
        </Button>
      ) : null}
    </Section>
  );
}

function placeOf({ location }: Device): readonly [number, number] {
  return [location.x, location.y];
}

function Uses({ device }: { device: Device }) {
  const open = useOpenProgram();
  const { document, scene, speaker, t } = open;
  const steps = sortByReading(scene.tree, usesOf(document, { kind: "device", id: device.id }));
  const chips = steps.flatMap((id) => scene.chips.get(id) ?? []);
  const go = (id: string) => {
    select([id]);
    showSteps(open, [id]);
  };
  return (
    <Section title={t("device_panel.used")}>
      {chips.length === 0 ? <p className={classes.now}>{t("device_panel.unused")}</p> : null}
      <ul className={styles.uses}>
        {chips.map((chip) => (
          <li key={chip.id}>
            <button type="button" onClick={() => go(chip.id)}>
              {chipLabel(chip, speaker)}
            </button>
          </li>
        ))}
      </ul>
    </Section>
  );
}
