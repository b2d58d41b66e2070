/** A robot's map laid over the site's: what would change, before an admin decides. */
import { Button, Modal, Skeleton } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { CircleCheck, TriangleAlert } from "lucide-react";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices, useSiteMap } from "@/api/queries";
import { useChangeMap, useMapDifference } from "@/api/robotMaps";
import type { Device, MapDifference, MapTrouble, RobotMap, Site } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatNumber, withUnit } from "@/i18n/format";
import { differencePaths, sharedBox } from "@/map/floor/mapDifference";
import { StaticMap } from "@/map/StaticMap";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import styles from "./robotmap.module.css";
import { planOf } from "./robotPlan";

const CHANGES = [
  ["wallsGained", "walls_gained_m2"],
  ["wallsLost", "walls_lost_m2"],
  ["floorGained", "floor_gained_m2"],
  ["floorLost", "floor_lost_m2"],
] as const;

interface UseProps {
  site: Site;
  device: Device;
  map: RobotMap;
  onClose: () => void;
}

function Overlay({ site, device, map }: Omit<UseProps, "onClose">) {
  const { t } = useTranslation();
  const present = useSiteMap(site.has_map ? site.slug : undefined).data ?? null;
  const machines = (useDevices(site.slug).data ?? []).filter(
    (each) => each.kind === "machine" || each.id === device.id,
  );
  const plan = useMemo(() => planOf(map), [map]);
  const paths = useMemo(() => (present ? differencePaths(present, plan) : null), [present, plan]);
  const focus = useMemo(() => (present ? sharedBox(present, plan) : undefined), [present, plan]);
  return (
    <div className={styles.overlay}>
      <StaticMap
        plan={present ?? plan}
        devices={machines}
        focus={focus}
        label={t("robotMap.over", { name: device.name, site: site.name })}
      >
        {paths ? CHANGES.map(([name]) => <path key={name} d={paths[name]} className={styles[name]} />) : null}
      </StaticMap>
    </div>
  );
}

function Changes({ difference }: { difference: MapDifference }) {
  const { t } = useTranslation();
  return (
    <dl className={styles.changes}>
      {CHANGES.map(([name, field]) => (
        <div key={name}>
          <dt>
            <svg width={14} height={14} aria-hidden="true">
              <rect width={14} height={14} rx={3} className={styles[name]} />
            </svg>
            {t(`robotMap.change.${name}`)}
          </dt>
          <dd>{withUnit(formatNumber(difference[field], 1), "m²")}</dd>
        </div>
      ))}
    </dl>
  );
}

export function UseRobotMap({ site, device, map, onClose }: UseProps) {
  const { t } = useTranslation();
  useReturnFocus();
  const difference = useMapDifference(site.slug, device.id);
  const change = useChangeMap(site.slug, useTellUnseen());
  const problem = change.error ?? difference.error;
  const { data } = difference;
  // Only what is on the screen is decided about: a newer map is shown first.
  const ready = data?.tag === map.tag;
  const suits = !data?.troubles.some((trouble) => trouble.is_new);
  const use = () => {
    if (!data) return;
    const { version, tag, replaces, replaces_tag } = data;
    change.mutate(
      { do: "use", device: device.id, version, tag, replaces, replaces_tag },
      {
        onSuccess: (made) => {
          notifications.show({ message: t("robotMap.used", { name: device.name, version: made.version }) });
          onClose();
        },
      },
    );
  };
  return (
    <Modal opened onClose={onClose} title={t("robotMap.ask", { name: device.name })} size={1040}>
      <div className={styles.ask}>
        <Overlay site={site} device={device} map={map} />
        <div className={styles.about}>
          <p>{t("robotMap.text")}</p>
          {data ? <Changes difference={data} /> : null}
          {data ? <MapTroubles site={site} troubles={data.troubles} /> : null}
          {difference.isPending ? <Skeleton height={120} /> : null}
          {problem ? (
            <p role="alert" className={styles.problem}>
              {problemText(problem, t("shell.problem.screen"))}
            </p>
          ) : null}
        </div>
      </div>
      <div className={styles.decide}>
        <Button variant="default" onClick={onClose} data-autofocus>
          {t("keys.cancel")}
        </Button>
        <Button onClick={use} disabled={!ready} loading={change.isPending}>
          {t(suits ? "robotMap.confirm" : "robotMap.confirmAllTheSame")}
        </Button>
      </div>
    </Modal>
  );
}

function Trouble({ site, trouble }: { site: Site; trouble: MapTrouble }) {
  const { t } = useTranslation();
  const isMachine = trouble.kind === "machine";
  return (
    <li data-new={trouble.is_new || undefined}>
      {isMachine ? <Link to={`/sites/${site.slug}/devices/${trouble.id}`}>{trouble.name}</Link> : <b>{trouble.name}</b>}{" "}
      <span>{t(`robotMap.trouble.${isMachine ? "machine" : "place"}.${trouble.why}`)}</span>
      {trouble.is_new ? null : <small> {t("robotMap.trouble.already")}</small>}
    </li>
  );
}

export function MapTroubles({ site, troubles }: { site: Site; troubles: readonly MapTrouble[] }) {
  const { t } = useTranslation();
  const sorted = [...troubles].sort((a, b) => Number(b.is_new) - Number(a.is_new));
  const count = troubles.filter((each) => each.is_new).length;
  const Icon = count > 0 ? TriangleAlert : CircleCheck;
  return (
    <section className={styles.troubles} aria-labelledby="map-troubles">
      <h3 id="map-troubles" data-bad={count > 0 || undefined}>
        <Icon size={16} aria-hidden="true" />
        {count > 0 ? t("robotMap.trouble.some", { count }) : t("robotMap.trouble.none")}
      </h3>
      <ul>
        {sorted.map((trouble) => (
          <Trouble key={`${trouble.kind} ${trouble.id}`} site={site} trouble={trouble} />
        ))}
      </ul>
    </section>
  );
}
