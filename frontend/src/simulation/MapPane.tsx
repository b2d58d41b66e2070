import { useMemo } from "react";
import { Maximize2, Minimize2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { Compiled, Device, ProgramDocument, RehearsalResult, SiteMap } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { ProgramMap } from "@/program/ProgramMap";
import type { RobotSource } from "@/map/robots/robots";
import { latest, poseAt } from "@/scene3d/frames";
import { ownEntry } from "@/design/ownEntry";
import { IncidentMarks } from "./incidents/IncidentMarks";
import { type Incident, isNow } from "@/scene3d/incidents";
import { InSmall } from "./incidents/InSmall";
import styles from "./SimulationScreen.module.css";
import type { Moment } from "@/scene3d/types";
import { statusesAt } from "./timeline";

interface MapPaneProps {
  site: string;
  map: SiteMap | undefined;
  devices: Device[];
  document: ProgramDocument;
  compiled: Compiled;
  result: RehearsalResult | null;
  moment: Moment;
  t_s: number;
  selected: string | null;
  onSelect: (step: string | null) => void;
  incidents: readonly Incident[];
  wordsOf: (incident: Incident) => string;
  onJump: (t_s: number) => void;
  /** The map has the large place, and the 3D view the small one. */
  large: boolean;
  onLarge: () => void;
}

/** Where the recording has the robots at the moment that is shown, asked for with every picture. */
function useRecordedRobots(devices: Device[], result: RehearsalResult | null, moment: Moment): RobotSource {
  return useMemo(() => {
    const robots = devices.filter((device) => device.kind === "robot");
    const routes = new Map(
      robots.map((robot) => [
        robot.id,
        (result?.routes ?? []).filter((r) => r.robot === robot.id).map((r) => [r.t, r.path] as const),
      ]),
    );
    return () =>
      robots.map((robot) => {
        const pose = result && poseAt(result.frames, robot.id, moment.t_s);
        const [x, y, theta] = pose ?? [robot.location.x, robot.location.y, robot.location.theta];
        const load = latest(ownEntry(result?.carrying, robot.id), moment.t_s)?.[1] ?? {};
        return {
          id: robot.id,
          name: "",
          status: "idle" as const,
          x,
          y,
          theta,
          carrying: Object.values(load).some((count) => count > 0),
          route: latest(routes.get(robot.id), moment.t_s)?.[1],
        };
      });
  }, [devices, result, moment]);
}

/** The devices as the recording has them: busy or not, and without what they say of themselves right now. */
function useRecordedDevices(devices: Device[], result: RehearsalResult | null, t_s: number): Device[] {
  const busy = devices.map((device) => latest(ownEntry(result?.machine_states, device.id), t_s)?.[1] ?? false);
  const key = busy.join();
  return useMemo(
    () =>
      devices
        .filter((device) => device.lifecycle === "approved")
        .map((device) => ({
          ...device,
          doing: "",
          properties: [],
          status: key.split(",")[devices.indexOf(device)] === "true" ? ("busy" as const) : ("idle" as const),
        })),
    [devices, key],
  );
}

/** The program on the map, with every step and robot as it is at the moment that is shown. */
export function MapPane(props: MapPaneProps) {
  const { t } = useTranslation();
  const { result, t_s } = props;
  const devices = useRecordedDevices(props.devices, result, t_s);
  const robots = useRecordedRobots(props.devices, result, props.moment);
  const statuses = useMemo(() => {
    const now = result ? statusesAt(result.steps, t_s) : {};
    return Object.fromEntries(Object.entries(now).map(([step, status]) => [step, { status }]));
  }, [result, t_s]);
  const waiting = props.incidents.filter((each) => each.kind === "wait" && isNow(each, t_s)).map(({ robot }) => robot);
  const plane = result ? (
    <>
      <InSmall
        robots={props.devices.filter((device) => device.kind === "robot")}
        frames={result.frames}
        moment={props.moment}
        noteOf={(robot) => (waiting.includes(robot) ? t("simulation.waitsNow") : "")}
      />
      <IncidentMarks incidents={props.incidents} t_s={t_s} wordsOf={props.wordsOf} onJump={props.onJump} />
    </>
  ) : null;
  return (
    <section
      className={`${styles.pane} ${styles.map}`}
      data-large={props.large || undefined}
      aria-label={t("simulation.map")}
    >
      <header className={styles.paneHead}>
        <h2>{t("simulation.map")}</h2>
        <span>{t("simulation.sameMoment")}</span>
        <IconButton label={t(props.large ? "simulation.mapSmaller" : "simulation.mapLarger")} onClick={props.onLarge}>
          {props.large ? <Minimize2 size={16} aria-hidden="true" /> : <Maximize2 size={16} aria-hidden="true" />}
        </IconButton>
      </header>
      <div className={styles.mapBody}>
        <ProgramMap
          site={props.site}
          plan={props.map ?? null}
          devices={devices}
          document={props.document}
          compiled={props.compiled}
          statuses={statuses}
          robots={robots}
          selected={props.selected}
          onSelect={props.onSelect}
          plane={plane}
        />
      </div>
    </section>
  );
}
