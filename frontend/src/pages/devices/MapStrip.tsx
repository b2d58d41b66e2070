import { Skeleton } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { useSiteMap } from "@/api/queries";
import type { Device, Site } from "@/api/types";
import { LoadProblem } from "@/shell/LoadProblem";
import { Panel } from "@/design/Panel";
import { StatusBadge } from "@/design/StatusBadge";
import { useLiveStore } from "@/live/store";
import { StaticMap } from "@/map/StaticMap";
import { pendingOf } from "./filter";
import { PendingDevice } from "./PendingDevice";
import styles from "./devices.module.css";

interface StripProps {
  site: Site;
  devices: Device[];
  chosen: string | undefined;
}

/** Without its map a site's devices are shown as they stand to each other; a map that is still to come is waited for. */
function Floor({ site, devices, chosen }: StripProps) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const map = useSiteMap(site.has_map ? site.slug : undefined);
  if (site.has_map && map.isLoadingError) return <LoadProblem error={map.error} again={() => void map.refetch()} />;
  if (site.has_map && !map.data) return <Skeleton className={styles.stripWaits} aria-hidden="true" />;
  return (
    <StaticMap
      plan={map.data ?? null}
      devices={devices.filter((device) => device.lifecycle !== "retired")}
      selected={chosen ?? null}
      onSelect={(id) => void navigate(`/sites/${site.slug}/devices/${id}`)}
      label={t("pages.map.of", { site: site.name })}
    />
  );
}

/** Where the devices stand, and one of those that want to join. */
export function MapStrip({ site, devices, chosen }: StripProps) {
  const { t } = useTranslation();
  const live = useLiveStore((state) => state.connection === "live");
  const pending = pendingOf(devices, chosen);
  return (
    <Panel className={styles.strip}>
      <div className={styles.stripMap}>
        <Floor site={site} devices={devices} chosen={chosen} />
        <span className={styles.liveMark}>
          <StatusBadge status={live ? "done" : "offline"}>{t(live ? "pages.live" : "pages.notLive")}</StatusBadge>
        </span>
      </div>
      {pending ? <PendingDevice key={pending.id} device={pending} site={site} /> : null}
    </Panel>
  );
}
