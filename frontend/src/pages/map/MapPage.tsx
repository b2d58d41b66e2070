/** The site's map, large, with its places and zones, what there is to know about it and its ROS files. */
import { Button, Skeleton } from "@mantine/core";
import { Check, MapPin, MapPinned, Move, SquareDashed, TrafficCone, type LucideIcon } from "lucide-react";
import { useEffect, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate, useParams, useSearchParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useDevices, useSite, useSiteMap } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Site, SiteMap } from "@/api/types";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { formatNumber, formatPoint, withUnit } from "@/i18n/format";
import { StaticMap } from "@/map/StaticMap";
import { useAsHeld } from "@/live/held";
import { LoadProblem } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { type Point, toPixels } from "@/map/plane/projection";
import { MovableMachine } from "../devices/MovableMachine";
import { FloorCheckMarks } from "./check/FloorCheckMarks";
import { FloorCheckPanel } from "./check/FloorCheckPanel";
import { useFloorCheckView } from "./check/useFloorCheckView";
import { EditMapButton } from "./EditMapButton";
import { LayersCard } from "./layers/LayersCard";
import { useLayers } from "./layers/useLayers";
import { MapExports } from "./MapExports";
import styles from "./MapPage.module.css";
import { MappingRobots } from "./MappingRobots";
import { MapVersions } from "./MapVersions";
import { MeasureButton } from "./measure/MeasureButton";
import { MeasurePanel } from "./measure/MeasurePanel";
import { MeasureTool } from "./measure/MeasureTool";
import { useMeasuring } from "./measure/useMeasuring";
import { ObstacleHandles } from "./obstacles/ObstacleHandles";
import { ObstaclesPanel } from "./obstacles/ObstaclesPanel";
import { useObstacles } from "./obstacles/useObstacles";
import { PlaceHandles } from "./places/PlaceHandles";
import { PlacesPanel } from "./places/PlacesPanel";
import { usePlaces } from "./places/usePlaces";
import { useFloorCounts } from "./useFloorCounts";
import { useZoomedView } from "./useZoomedView";
import { ZoomControls } from "./ZoomControls";
import { useZones } from "./zones/useZones";
import { ZoneHandles } from "./zones/ZoneHandles";
import { ZonesPanel } from "./zones/ZonesPanel";

function Facts({ map }: { map: SiteMap }) {
  const { t } = useTranslation();
  const { free, known } = useFloorCounts(map.cells);
  const metres = (value: number, digits = 1) => withUnit(formatNumber(value, digits), "m");
  const facts: [string, string][] = [
    ["size", `${metres(map.width * map.resolution_m)} × ${metres(map.height * map.resolution_m)}`],
    ["free", withUnit(formatNumber(free * map.resolution_m ** 2, 1), "m²")],
    ["known", withUnit(formatNumber(known * 100), "%")],
    ["resolution", withUnit(formatNumber(map.resolution_m * 100, 1), t("pages.map.perCell"))],
    ["cells", `${formatNumber(map.width)} × ${formatNumber(map.height)}`],
    ["origin", formatPoint(map.origin.x, map.origin.y)],
  ];
  return (
    <dl className={styles.facts}>
      {facts.map(([name, value]) => (
        <div key={name}>
          <dt>{t(`pages.map.fact.${name}`)}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}

/** What somebody is changing on the map. */
type Mode = "machines" | "places" | "zones" | "obstacles";
const MODES: readonly { mode: Mode; icon: LucideIcon; begin: string; end: string }[] = [
  { mode: "places", icon: MapPin, begin: "place.edit", end: "place.finish" },
  { mode: "zones", icon: SquareDashed, begin: "zone.edit", end: "zone.finish" },
  { mode: "machines", icon: Move, begin: "placing.move", end: "placing.finish" },
  { mode: "obstacles", icon: TrafficCone, begin: "obstacle.edit", end: "obstacle.finish" },
];

/** Admins change the map; who runs programs puts something in the way of robots, where some are simulated. */
function useModes(site: Site | undefined): readonly Mode[] {
  const devices = useDevices(site?.slug).data ?? [];
  const isSimulated = devices.some(({ kind, simulated, lifecycle }) => {
    return kind === "robot" && simulated && lifecycle === "approved";
  });
  const modes: Mode[] = site?.role === "admin" ? ["places", "zones", "machines"] : [];
  return isSimulated && mayOperate(site?.role) ? [...modes, "obstacles"] : modes;
}

interface ModeButtonsProps {
  allowed: readonly Mode[];
  mode: Mode | null;
  change: (mode: Mode | null) => void;
}

function ModeButtons({ allowed, mode, change }: ModeButtonsProps) {
  const { t } = useTranslation();
  return MODES.filter((each) => allowed.includes(each.mode)).map((each) => {
    const isOn = mode === each.mode;
    const Icon = isOn ? Check : each.icon;
    return (
      <Button
        key={each.mode}
        variant={isOn ? "filled" : "default"}
        classNames={{ label: styles.actionLabel ?? "", section: styles.actionIcon ?? "" }}
        title={t(isOn ? each.end : each.begin)}
        leftSection={<Icon size={16} aria-hidden="true" />}
        onClick={() => change(isOn ? null : each.mode)}
      >
        {t(isOn ? each.end : each.begin)}
      </Button>
    );
  });
}

/** Around the place that was asked for; its name stands on the floor. */
function PlaceMark({ at }: { at: Point }) {
  const { x, y } = toPixels(at);
  return <circle cx={x} cy={y} r={30} fill="none" stroke="var(--brand)" strokeWidth={5} />;
}

interface MapViewProps {
  site: Site;
  map: SiteMap;
  mode: Mode | null;
  change: (mode: Mode) => void;
  /** Ends measuring; null while nobody measures. */
  stopMeasuring: (() => void) | null;
}

function MapView({ site, map, mode, change, stopMeasuring }: MapViewProps) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const [query] = useSearchParams();
  const seen = useZoomedView();
  const places = usePlaces(site.slug, map);
  const zones = useZones(site.slug, map);
  const obstacles = useObstacles(site.slug);
  const check = useFloorCheckView(site.slug, map, mode === null);
  const asked = map.places.find((each) => each.id === query.get("place"));
  const layers = useLayers(site.slug, map, { on: mode === null, asked: asked?.id ?? null });
  const devices = (useAsHeld(useDevices(site.slug).data) ?? []).filter((device) => device.lifecycle !== "retired");
  const measure = useMeasuring(map, devices, stopMeasuring !== null);
  const movable = mode === "machines" ? devices.filter((device) => device.kind === "machine") : [];
  const bare = useMemo(() => ({ ...map, places: [] }), [map]);
  const cleared = useMemo(() => ({ ...map, obstacles: [] }), [map]);
  const { stop: stopPlace } = places;
  const { stop: stopZone } = zones;
  useEffect(() => {
    if (mode !== "places") stopPlace(); // who comes back adds nothing
    if (mode !== "zones") stopZone();
  }, [mode]); // oxlint-disable-line react/exhaustive-deps -- when the mode is another, and only then
  const editZone = (zone: string | null) => {
    zones.select(zone);
    change("zones");
  };
  const open = (id: string) => void navigate(`/sites/${site.slug}/devices/${id}`);
  return (
    <div className={styles.page}>
      <Panel className={styles.map}>
        <StaticMap
          plan={mode === "places" ? bare : mode === "obstacles" ? cleared : layers.plan}
          under={layers.under}
          devices={devices.filter(
            (device) =>
              !movable.includes(device) && !((mode === "places" || mode === "zones") && device.kind === "robot"),
          )}
          named
          seen={seen}
          editing={mode !== null || stopMeasuring !== null}
          selected={query.get("device")}
          onSelect={!stopMeasuring && (mode === null || mode === "machines") ? open : undefined}
          label={t("pages.map.of", { site: site.name })}
        >
          {movable.map((device) => (
            <MovableMachine key={device.id} site={site} map={map} device={device} />
          ))}
          {mode === "places" ? <PlaceHandles slug={site.slug} map={map} places={places} /> : null}
          {mode === "zones" ? <ZoneHandles slug={site.slug} map={map} zones={zones} /> : null}
          {mode === "obstacles" ? <ObstacleHandles slug={site.slug} map={map} editing={obstacles} /> : null}
          {mode === null && (layers.chosen.check || check.chosen) ? (
            <FloorCheckMarks map={map} devices={devices} view={check} />
          ) : null}
          {asked && mode !== "places" ? <PlaceMark at={[asked.x, asked.y]} /> : null}
          {stopMeasuring ? <MeasureTool map={map} view={measure} stop={stopMeasuring} /> : null}
        </StaticMap>
        <ZoomControls zoomed={seen} />
        {mode === null ? <LayersCard layers={layers} /> : null}
      </Panel>
      <Panel className={styles.about}>
        {stopMeasuring ? <MeasurePanel measuring={measure.measuring} /> : null}
        {mode === "machines" ? <p id="placing-help">{t("placing.help")}</p> : null}
        {mode === null || mode === "machines" ? <About map={map} /> : null}
        {mode === null ? (
          <FloorCheckPanel slug={site.slug} map={map} view={check} editZone={site.role === "admin" ? editZone : null} />
        ) : null}
        {mode === null || mode === "obstacles" ? (
          <ObstaclesPanel map={map} editing={mode === "obstacles" ? obstacles : null} />
        ) : null}
        {mode === "zones" || mode === "obstacles" ? null : (
          <PlacesPanel slug={site.slug} map={map} editing={mode === "places" ? places : null} />
        )}
        {mode === "places" || mode === "obstacles" ? null : (
          <ZonesPanel slug={site.slug} map={map} editing={mode === "zones" ? zones : null} />
        )}
        {mode === null || mode === "machines" ? <MapVersions site={site} /> : null}
      </Panel>
    </div>
  );
}

function About({ map }: { map: SiteMap }) {
  const { t } = useTranslation();
  return (
    <>
      <h2>{t("pages.map.about")}</h2>
      <Facts map={map} />
    </>
  );
}

export function MapPage() {
  const { t } = useTranslation();
  const { slug = "" } = useParams();
  const site = useSite(slug);
  const map = useSiteMap(site.data?.has_map ? slug : undefined);
  const [query] = useSearchParams();
  const [mode, setMode] = useState<Mode | "measure" | null>(query.has("places") ? "places" : null);
  const isMeasuring = mode === "measure";
  const modes = useModes(site.data);
  const editing = mode !== null && mode !== "measure" && modes.includes(mode) ? mode : null;
  const problem = missing(site, map);
  return (
    <PageShell
      title={t("shell.nav.map")}
      chips={map.data ? <Chip>{t("pages.map.version", { version: map.data.version })}</Chip> : null}
      actions={
        map.data ? (
          <>
            <ModeButtons allowed={modes} mode={editing} change={setMode} />
            <MeasureButton isOn={isMeasuring} toggle={() => setMode(isMeasuring ? null : "measure")} />
            {site.data?.role === "admin" ? <EditMapButton slug={slug} /> : null}
            <MapExports slug={slug} />
          </>
        ) : null
      }
    >
      {problem ? <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), map.refetch()])} /> : null}
      {!problem && !map.data && site.data?.has_map !== false ? <Skeleton height="100%" radius="lg" /> : null}
      {site.data && map.data ? (
        <MapView
          site={site.data}
          map={map.data}
          mode={editing}
          change={setMode}
          stopMeasuring={isMeasuring ? () => setMode(null) : null}
        />
      ) : null}
      {site.data?.has_map === false ? (
        <Panel>
          <EmptyState icon={<MapPinned size={20} />} title={t("pages.map.none")} text={t("pages.map.noneText")}>
            {site.data.role === "admin" ? (
              <Button component={Link} to={`/sites/${slug}/map/new`}>
                {t("mapEdit.upload")}
              </Button>
            ) : null}
            <MappingRobots slug={slug} waiting={site.data.role === "admin"} />
          </EmptyState>
        </Panel>
      ) : null}
    </PageShell>
  );
}
