/** A robot's map laid over the site's: what would change, before an admin decides. */
import { Button, Modal, Skeleton } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { useDevices, useSiteMap } from "@/api/queries";
import { useChangeMap, useMapDifference } from "@/api/robotMaps";
import type { Device, MapDifference, RobotMap, Site } from "@/api/types";
import { problemText } from "@/app/LoadProblem";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatNumber, withUnit } from "@/i18n/format";
import { differencePaths, sharedBox } from "@/map/mapDifference";
import { StaticMap } from "@/map/StaticMap";
import { MapTroubles } from "./MapTroubles";
import { planOf } from "./robotPlan";
import styles from "./robotmap.module.css";

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
  const change = useChangeMap(site.slug);
  const problem = change.error ?? difference.error;
  const { data } = difference;
  // Only what is on the screen is decided about: a newer map is shown first.
  const ready = data?.version === map.version;
  const suits = !data?.troubles.some((trouble) => trouble.is_new);
  const use = () =>
    data &&
    change.mutate(
      { do: "use", device: device.id, version: data.version, replaces: data.replaces },
      {
        onSuccess: ({ version }) => {
          notifications.show({ message: t("robotMap.used", { name: device.name, version }) });
          onClose();
        },
      },
    );
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
