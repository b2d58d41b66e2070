/** The map that a robot has made, as it is now, and what can be done with it. */
import { Button, Skeleton } from "@mantine/core";
import { MapPinned } from "lucide-react";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { robotMapFile, useRobotMap } from "@/api/robotMaps";
import type { Device, RobotMap, Site } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { TryButton } from "@/device/methods/TryButton";
import { StatusBadge } from "@/design/StatusBadge";
import { formatAge, formatAgo, formatNumber, withUnit } from "@/i18n/format";
import { StaticMap } from "@/map/StaticMap";
import { MapDownloads } from "../../map/MapDownloads";
import { useNow } from "@/design/useNow";
import { planOf } from "./robotPlan";
import { EXPLORE } from "../../map/MappingRobots";
import { UseRobotMap } from "./UseRobotMap";
import styles from "./robotmap.module.css";

/** A robot that explores sends a map every 10 s; one that has not changed for so long is finished for now. */
const GROWING_MS = 60_000;

function Age({ map }: { map: RobotMap }) {
  const { t } = useTranslation();
  const now = useNow(1000);
  const grows = now - Date.parse(map.changed_at) < GROWING_MS;
  return (
    <StatusBadge status={grows ? "busy" : "done"}>
      {t(grows ? "robotMap.growing" : "robotMap.unchanged", { age: formatAge(map.changed_at, now) })}
    </StatusBadge>
  );
}

function Facts({ map }: { map: RobotMap }) {
  const { t } = useTranslation();
  const now = useNow();
  const metres = (cells: number) => withUnit(formatNumber(cells * map.resolution_m, 1), "m");
  const area = map.known * map.width * map.height * map.resolution_m ** 2;
  const facts: [string, string][] = [
    ["size", `${metres(map.width)} × ${metres(map.height)}`],
    ["known", withUnit(formatNumber(area, 1), "m²")],
    ["resolution", withUnit(formatNumber(map.resolution_m * 100, 1), "cm")],
    ["age", formatAgo(map.at, now)],
  ];
  return (
    <dl className={styles.facts}>
      {facts.map(([name, value]) => (
        <div key={name}>
          <dt>{t(`robotMap.fact.${name}`)}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}

function Picture({ device, map }: { device: Device; map: RobotMap }) {
  const { t } = useTranslation();
  const plan = useMemo(() => planOf(map), [map]);
  return (
    <>
      <div className={styles.picture}>
        <StaticMap plan={plan} devices={[device]} label={t("robotMap.of", { name: device.name })} />
      </div>
      <Facts map={map} />
    </>
  );
}

function UseMap({ site, device, map }: { site: Site; device: Device; map: RobotMap }) {
  const { t } = useTranslation();
  const [using, setUsing] = useState(false);
  return (
    <>
      <Button leftSection={<MapPinned size={16} aria-hidden="true" />} onClick={() => setUsing(true)}>
        {t("robotMap.use")}
      </Button>
      {using ? <UseRobotMap site={site} device={device} map={map} onClose={() => setUsing(false)} /> : null}
    </>
  );
}

export function RobotMapCard({ site, device }: { site: Site; device: Device }) {
  const { t } = useTranslation();
  const { data: map, error, refetch, isPending } = useRobotMap(site.slug, device.id);
  const explore = device.methods.find((each) => each.name === EXPLORE);
  return (
    <section aria-labelledby="robot-map">
      <div className={styles.head}>
        <h3 id="robot-map">{t("robotMap.title")}</h3>
        {map ? <Age map={map} /> : null}
      </div>
      {isPending ? <Skeleton height={220} radius="lg" /> : null}
      {error ? (
        <p role="alert" className={styles.none}>
          {problemText(error, t("shell.problem.screen"))}{" "}
          <button type="button" className={styles.again} onClick={() => void refetch()}>
            {t("shell.problem.again")}
          </button>
        </p>
      ) : null}
      {map === null ? <p className={styles.none}>{t(explore ? "robotMap.explorer" : "robotMap.none")}</p> : null}
      {map ? <Picture device={device} map={map} /> : null}
      <div className={styles.actions}>
        {map && site.role === "admin" ? <UseMap site={site} device={device} map={map} /> : null}
        {explore && map !== undefined ? (
          <TryButton
            site={site}
            device={device}
            method={explore}
            words={t(map ? "robotMap.exploreAgain" : "robotMap.explore")}
            main={map === null}
          />
        ) : null}
        {map ? <MapDownloads fileOf={(form) => robotMapFile(site.slug, device.id, form)} /> : null}
      </div>
    </section>
  );
}
