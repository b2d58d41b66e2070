/** The sites one is a member of, each with its map. */
import { Button } from "@mantine/core";
import { Plus } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices, useMe, useOpenRuns, usePrograms, useSiteMap } from "@/api/queries";
import type { Site } from "@/api/types";
import { Panel } from "@/design/Panel";
import { StatusBadge } from "@/design/StatusBadge";
import { useNow } from "@/design/useNow";
import { StaticMap } from "@/map/StaticMap";
import { underWay } from "../runs/runStatus";
import styles from "./home.module.css";

function SiteState({ site, running }: { site: Site; running: boolean }) {
  const { t } = useTranslation();
  if (site.stop.active) return <StatusBadge status="error">{t("shell.stop.stopped")}</StatusBadge>;
  if (!site.has_map) return <StatusBadge status="idle">{t("pages.home.noMap")}</StatusBadge>;
  if (running) return <StatusBadge status="busy">{t("pages.home.running")}</StatusBadge>;
  return <StatusBadge status="idle">{t("shell.status.idle")}</StatusBadge>;
}

function SiteCard({ site }: { site: Site }) {
  const { t } = useTranslation();
  const map = useSiteMap(site.has_map ? site.slug : undefined).data ?? null;
  const devices = useDevices(site.slug).data ?? [];
  const programs = usePrograms(site.slug).data?.length ?? 0;
  const running = underWay(useOpenRuns(site.slug).data ?? [], useNow()).length > 0;
  const isBare = !site.has_map && site.role === "admin";
  const facts = [
    t("pages.home.machines", { count: site.machines }),
    t("pages.home.robots", { count: site.robots }),
    t("pages.home.programs", { count: programs }),
  ];
  return (
    <Panel className={styles.site}>
      <div className={styles.siteMap}>
        <StaticMap plan={map} devices={devices} label={t("pages.map.of", { site: site.name })} />
      </div>
      <div className={styles.siteText}>
        <div className={styles.siteHead}>
          <h3>{site.name}</h3>
          <SiteState site={site} running={running} />
        </div>
        <p>
          {facts.join(", ")}. {site.pending > 0 ? t("pages.home.pending", { count: site.pending }) : null}
        </p>
        <div className={styles.siteActions}>
          <Button
            component={Link}
            to={`/sites/${site.slug}/map${isBare ? "/new" : ""}`}
            variant={isBare ? "filled" : "default"}
            size="xs"
          >
            {t(isBare ? "mapEdit.upload" : "pages.home.openMap")}
          </Button>
          <Button component={Link} to={`/sites/${site.slug}/devices`} variant="default" size="xs">
            {t(site.pending > 0 ? "pages.home.review" : "shell.nav.devices")}
          </Button>
        </div>
      </div>
    </Panel>
  );
}

export function SiteCards({ sites }: { sites: readonly Site[] }) {
  const { t } = useTranslation();
  const mayAdd = useMe().data?.may_create_sites ?? false;
  return (
    <div className={styles.sites}>
      {sites.map((site) => (
        <SiteCard key={site.slug} site={site} />
      ))}
      {mayAdd ? (
        <Link to="/sites/new" className={styles.addSite}>
          <span className={styles.plus}>
            <Plus size={20} aria-hidden="true" />
          </span>
          <b>{t("shell.site.add")}</b>
          <span>{t("pages.home.addSiteText")}</span>
        </Link>
      ) : null}
    </div>
  );
}
