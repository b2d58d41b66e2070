/** A device that wants to join: who it says it is, and the admin's decision. */
import { Button } from "@mantine/core";
import { Check } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { Device, Site } from "@/api/types";
import { StatusGlyph } from "@/design/StatusGlyph";
import { formatNumber, withUnit } from "@/i18n/format";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { useDecide } from "./decisions";
import { useFocusInList } from "./focus";
import styles from "./devices.module.css";

function Facts({ device }: { device: Device }) {
  const { t } = useTranslation();
  const { x, y } = device.location;
  const at = `${withUnit(formatNumber(x, 2), "m")}, ${withUnit(formatNumber(y, 2), "m")}`;
  return (
    <dl className={styles.facts}>
      <dt>{t("pages.devices.place")}</dt>
      <dd>{at}</dd>
      <dt>{t("pages.devices.canDo")}</dt>
      <dd className={styles.methods}>
        {device.methods.map((method) => (
          <code key={method.name}>
            {`${method.name}(${method.parameters.map((parameter) => parameter.name).join(", ")})`}
          </code>
        ))}
      </dd>
      <dt>{t("pages.devices.id")}</dt>
      <dd>
        <code>{device.id}</code> {t("pages.devices.compare")}
      </dd>
    </dl>
  );
}

export function PendingDevice({ device, site }: { device: Device; site: Site }) {
  const { t } = useTranslation();
  const decide = useDecide(site.slug);
  useFocusInList(device.id);
  return (
    <section className={styles.pending} aria-labelledby="pending">
      <h2 id="pending">
        <StatusGlyph status="pending" size={16} />
        {t("pages.devices.wantsToJoin")}
      </h2>
      <div className={styles.pendingName}>
        <span className={styles.disc} data-status="pending">
          <DeviceIcon deviceClass={device.device_class} size={19} />
        </span>
        <span>
          <b>{device.name}</b>
          <span>
            {t("pages.devices.saysItIs", { what: t(`pages.devices.kind.${device.kind}`) })}
            {device.device_class ? ` (${device.device_class})` : null}
          </span>
        </span>
      </div>
      <Facts device={device} />
      {site.role === "admin" ? (
        <div className={styles.decide}>
          <Button
            leftSection={<Check size={16} />}
            loading={decide.isPending}
            onClick={() => decide.mutate({ do: "approve", device })}
          >
            {t("pages.devices.approve")}
          </Button>
          <Button
            variant="default"
            className={styles.reject}
            disabled={decide.isPending}
            onClick={() => decide.mutate({ do: "reject", device })}
          >
            {t("pages.devices.reject")}
          </Button>
        </div>
      ) : (
        <p className={styles.askAdmin}>{t("pages.devices.askAdmin")}</p>
      )}
    </section>
  );
}
