/** The devices that were taken out or turned away, for an admin who wants one back. */
import { Button } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { useRetiredDevices } from "@/api/queries";
import type { Site } from "@/api/types";
import { Panel } from "@/design/Panel";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { useDecide } from "./decisions";
import styles from "./keys/keys.module.css";

export function RetiredDevices({ site }: { site: Site }) {
  const { t } = useTranslation();
  const retired = useRetiredDevices(site.role === "admin" ? site.slug : undefined).data ?? [];
  const decide = useDecide(site.slug);
  if (retired.length === 0) return null;
  return (
    <Panel className={styles.retired}>
      <details>
        <summary>{`${t("keys.retired")} (${retired.length})`}</summary>
        <ul>
          {retired.map((device) => (
            <li key={device.id}>
              <DeviceIcon deviceClass={device.device_class} size={17} />
              <span>{device.name}</span>
              <code>{device.id}</code>
              <Button
                size="compact-sm"
                variant="default"
                aria-label={`${t("keys.readmit")}: ${device.name}`}
                disabled={decide.isPending}
                onClick={() => decide.mutate({ do: "readmit", device })}
              >
                {t("keys.readmit")}
              </Button>
            </li>
          ))}
        </ul>
      </details>
    </Panel>
  );
}
