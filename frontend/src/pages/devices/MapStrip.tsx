import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { useSiteMap } from "@/api/queries";
import type { Device, Site } from "@/api/types";
import { Panel } from "@/design/Panel";
import { StatusBadge } from "@/design/StatusBadge";
import { useLiveStore } from "@/live/store";
import { StaticMap } from "@/map/StaticMap";
import { Newcomer } from "./Newcomer";
import styles from "./devices.module.css";

/** Where the devices stand, and the first of those that want to join. */
export function MapStrip({ site, devices, chosen }: { site: Site; devices: Device[]; chosen: string | undefined }) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const map = useSiteMap(site.has_map ? site.slug : undefined).data ?? null;
  const live = useLiveStore((state) => state.connection === "live");
  const newcomer = devices.find((device) => device.lifecycle === "pending");
  return (
    <Panel className={styles.strip}>
      <div className={styles.stripMap}>
        <StaticMap
          plan={map}
          devices={devices.filter((device) => device.lifecycle !== "retired")}
          selected={chosen ?? null}
          onSelect={(id) => void navigate(`/sites/${site.slug}/devices/${id}`)}
          label={t("pages.map.of", { site: site.name })}
        />
        <span className={styles.liveMark}>
          <StatusBadge status={live ? "done" : "offline"}>{t(live ? "pages.live" : "pages.notLive")}</StatusBadge>
        </span>
      </div>
      {newcomer ? <Newcomer device={newcomer} site={site} /> : null}
    </Panel>
  );
}
