/** The registry: where the devices are, who wants to join, what each can do. */
import { Button } from "@mantine/core";
import { Cpu, Download } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { useAsHeld } from "@/live/held";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { missing } from "@/api/failed";
import { useDevices, useSite } from "@/api/queries";
import type { Device, Site } from "@/api/types";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { StatusGlyph } from "@/design/StatusGlyph";
import { AddDevice } from "./enrolment/AddDevice";
import { DeviceDetail } from "./DeviceDetail";
import { DeviceFilters } from "./DeviceFilters";
import { DeviceTable } from "./DeviceTable";
import { KeyShown } from "./keys/KeyShown";
import { RetiredDevices } from "./RetiredDevices";
import styles from "./devices.module.css";
import { filterDevices, NO_FILTER } from "./filter";
import { MapStrip } from "./MapStrip";
import { NoSuch } from "../NoSuch";
import { NothingFound } from "../NothingFound";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";

function Registry({ site, devices, chosen }: { site: Site; devices: Device[]; chosen: string | undefined }) {
  const { t } = useTranslation();
  const [filter, setFilter] = useState(NO_FILTER);
  const found = filterDevices(devices, filter);
  return (
    <div className={pages.stack}>
      <MapStrip site={site} devices={devices} chosen={chosen} />
      <div className={styles.toolbar}>
        <DeviceFilters devices={devices} filter={filter} change={setFilter} />
        {site.pending > 0 ? (
          <span className={styles.waiting}>
            <Chip tone="pend">
              <StatusGlyph status="pending" size={13} />
              {t("pages.devices.waiting", { count: site.pending })}
            </Chip>
          </span>
        ) : null}
      </div>
      <Panel>
        {devices.length === 0 ? (
          <EmptyState icon={<Cpu size={20} />} title={t("pages.devices.none")} text={t("pages.devices.noneText")} />
        ) : null}
        {found.length > 0 ? <DeviceTable devices={found} slug={site.slug} chosen={chosen} /> : null}
        {devices.length > 0 && found.length === 0 ? <NothingFound clear={() => setFilter(NO_FILTER)} /> : null}
      </Panel>
      <RetiredDevices site={site} />
      <KeyShown />
    </div>
  );
}

function Actions({ site }: { site: Site }) {
  const { t } = useTranslation();
  return (
    <>
      <Button
        component="a"
        href={`/api/sites/${site.slug}/devices.ttl`}
        download
        variant="default"
        classNames={{ label: styles.exportLabel ?? "", section: styles.exportIcon ?? "" }}
        leftSection={<Download size={16} aria-hidden="true" />}
      >
        {t("adding.export")}
      </Button>
      <AddDevice site={site} />
    </>
  );
}

export function DevicesPage() {
  const { t } = useTranslation();
  const { slug = "", id } = useParams();
  const site = useSite(slug);
  const devices = useDevices(slug);
  const told = useAsHeld(devices.data);
  const chosen = told?.find((device) => device.id === id);
  const problem = missing(site, devices);
  return (
    <PageShell
      title={t("shell.nav.devices")}
      chips={
        site.data ? (
          <Chip>
            {`${t("pages.home.machines", { count: site.data.machines })}, ${t("pages.home.robots", { count: site.data.robots })}`}
          </Chip>
        ) : null
      }
      actions={site.data ? <Actions site={site.data} /> : null}
      detail={site.data && chosen ? <DeviceDetail key={chosen.id} site={site.data} device={chosen} /> : null}
    >
      {problem ? (
        <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), devices.refetch()])} />
      ) : null}
      {!problem && (site.isPending || devices.isPending) ? <TableSkeleton rows={10} /> : null}
      {id && devices.data && !chosen ? (
        <NoSuch
          words={t("pages.devices.noSuch", { id })}
          list={`/sites/${slug}/devices`}
          toList={t("pages.devices.toList")}
        />
      ) : null}
      {site.data && told ? <Registry site={site.data} devices={told} chosen={chosen?.id} /> : null}
    </PageShell>
  );
}
