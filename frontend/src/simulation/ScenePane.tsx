import { Camera, Map as MapIcon, Orbit, Radar, Tag, Target } from "lucide-react";
import { lazy, Suspense, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Device, RehearsalResult, SiteMap } from "@/api/types";
import { latest } from "./frames";
import { type Incident, isNow } from "./incidents/incidents";
import { Lidar } from "./lidar/Lidar";
import styles from "./SimulationScreen.module.css";
import type { CameraMode, Moment } from "./scene/types";
import { clock } from "@/design/clock";

const Scene3D = lazy(() => import("./scene/Scene3D").then((module) => ({ default: module.Scene3D })));

interface ScenePaneProps {
  map: SiteMap | undefined;
  devices: Device[];
  result: RehearsalResult | null;
  moment: Moment;
  t_s: number;
  playing: boolean;
  incidents: readonly Incident[];
  onJump: (t_s: number) => void;
}

const MODES: { mode: CameraMode; icon: typeof Orbit }[] = [
  { mode: "orbit", icon: Orbit },
  { mode: "top", icon: MapIcon },
  { mode: "follow", icon: Target },
  { mode: "robot", icon: Camera },
];

function hasWebgl(): boolean {
  const canvas = document.createElement("canvas");
  return canvas.getContext("webgl2") !== null;
}

/** What is said of each device at the moment: what a robot carries, whether a machine is busy. */
function useStateOf({ result, t_s, incidents }: ScenePaneProps) {
  const { t } = useTranslation();
  const now = incidents.filter((each) => each.kind === "wait" && isNow(each, t_s));
  return (device: string): string => {
    const wait = now.find(({ robot }) => robot === device)?.wait;
    if (wait) return t("simulation.waitsFor", { seconds: Math.round(wait.duration_s) });
    const load = latest(result?.carrying[device], t_s)?.[1] ?? {};
    const carried = Object.entries(load).filter(([, count]) => count > 0);
    if (carried.length > 0) {
      return t("simulation.carries", { load: carried.map(([object, count]) => `${count} × ${object}`).join(", ") });
    }
    return latest(result?.machine_states[device], t_s)?.[1] ? t("simulation.busy") : "";
  };
}

function Legend() {
  const { t } = useTranslation();
  return (
    <ul className={styles.legend}>
      <li>
        <i className={styles.lampTop} /> {t("simulation.lampTop")}
      </li>
      <li>
        <i className={styles.lampBottom} /> {t("simulation.lampBottom")}
      </li>
      <li className={styles.quiet}>{t("simulation.robotScale")}</li>
    </ul>
  );
}

function CameraBar(props: {
  mode: CameraMode;
  onMode: (mode: CameraMode) => void;
  robots: Device[];
  follow: string | null;
  onFollow: (robot: string) => void;
  names: boolean;
  onNames: () => void;
  lidar: boolean;
  onLidar: () => void;
}) {
  const { t } = useTranslation();
  return (
    <div className={styles.cameraBar}>
      <div className={styles.modes} role="radiogroup" aria-label={t("simulation.cameraMode")}>
        {MODES.map(({ mode, icon: Icon }) => (
          <button
            key={mode}
            type="button"
            role="radio"
            aria-checked={mode === props.mode}
            onClick={() => props.onMode(mode)}
          >
            <Icon size={15} aria-hidden /> {t(`simulation.${mode}`)}
          </button>
        ))}
      </div>
      {(props.mode === "follow" || props.mode === "robot" || props.lidar) && (
        <select
          className={styles.select}
          aria-label={t("simulation.followRobot")}
          value={props.follow ?? ""}
          onChange={(event) => props.onFollow(event.target.value)}
        >
          {props.robots.map((robot) => (
            <option key={robot.id} value={robot.id}>
              {robot.name}
            </option>
          ))}
        </select>
      )}
      <span className={styles.onTheRight}>
        <span className={styles.simulated}>{t("simulation.nothingMoves")}</span>
        <button type="button" className={styles.toggle} aria-pressed={props.lidar} onClick={props.onLidar}>
          <Radar size={15} aria-hidden /> {t("simulation.lidar")}
        </button>
        <button type="button" className={styles.toggle} aria-pressed={props.names} onClick={props.onNames}>
          <Tag size={15} aria-hidden /> {t("simulation.labels")}
        </button>
      </span>
    </div>
  );
}

/** The 3D view, or a sentence where the browser cannot show one. */
export function ScenePane(props: ScenePaneProps) {
  const { t } = useTranslation();
  const { map, devices, result, moment, t_s } = props;
  const robots = devices.filter((device) => device.kind === "robot");
  const [mode, setMode] = useState<CameraMode>("orbit");
  const [follow, setFollow] = useState<string | null>(null);
  const [names, setNames] = useState(true);
  const [lidar, setLidar] = useState(false);
  const [webgl] = useState(hasWebgl);
  const stateOf = useStateOf(props);
  const followed = follow ?? robots[0]?.id ?? null;
  const placed = devices
    .filter((device) => device.lifecycle === "approved")
    .map((d) => ({ ...d, radius_m: d.radius_m ?? 0.18 }));
  const seeing = lidar ? placed.find(({ id }) => id === followed) : undefined;
  const summary = robots.map((robot) => `${robot.name} ${stateOf(robot.id)}`.trim()).join(", ");
  return (
    <section className={`${styles.pane} ${styles.scene}`} aria-label={t("simulation.view3d")} data-scene>
      <CameraBar
        mode={mode}
        onMode={setMode}
        robots={robots}
        follow={followed}
        onFollow={setFollow}
        names={names}
        onNames={() => setNames(!names)}
        lidar={lidar}
        onLidar={() => setLidar(!lidar)}
      />
      {webgl && map ? (
        <Suspense fallback={<p className={styles.sceneNote}>{t("simulation.loading")}</p>}>
          <Scene3D
            map={map}
            devices={placed}
            recording={result}
            moment={moment}
            camera={mode}
            follow={followed}
            labels={names}
            playing={props.playing}
            t_s={t_s}
            label={t("simulation.sceneLabel", { time: clock(Math.floor(t_s)), summary })}
            stateOf={stateOf}
            incidents={props.incidents}
            onJump={props.onJump}
          />
        </Suspense>
      ) : (
        <p className={styles.sceneNote}>{t(webgl ? "simulation.loading" : "simulation.noWebgl")}</p>
      )}
      {seeing && map && result ? (
        <Lidar map={map} devices={placed} frames={result.frames} robot={seeing} moment={moment} />
      ) : null}
      <Legend />
    </section>
  );
}
