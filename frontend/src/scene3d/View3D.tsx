/** A place in 3D with the ways to look at it, or a sentence where the browser cannot show one. */
import { Camera, Map as MapIcon, Orbit, Tag, Target } from "lucide-react";
import { lazy, type ReactNode, Suspense, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Device } from "@/api/types";
import { Segments } from "@/design/Segments";
import type { Incident } from "./incidents";
import type { CameraMode, CopyOf, Moment, SceneDevice, SceneMap, SceneRecording } from "./types";
import styles from "./View3D.module.css";

const Scene3D = lazy(() => import("./Scene3D").then((module) => ({ default: module.Scene3D })));

const MODES: { mode: CameraMode; icon: typeof Orbit }[] = [
  { mode: "orbit", icon: Orbit },
  { mode: "top", icon: MapIcon },
  { mode: "follow", icon: Target },
  { mode: "robot", icon: Camera },
];
const USUAL_RADIUS_M = 0.18;

interface View3DProps {
  map: SceneMap | undefined;
  devices: readonly Device[];
  recording: SceneRecording | null;
  moment: Moment;
  t_s: number;
  /** While it plays each picture is drawn; else only when something changes. */
  playing: boolean;
  /** It is kept as a film, all pictures of which are as large. */
  filming?: boolean;
  /** What is said of a device at the moment, beside its name. */
  stateOf: (device: string) => string;
  /** The picture in words, of what is said of the robots. */
  labelOf: (summary: string) => string;
  /** What kind of picture this is, always in view. */
  sign: string;
  /** Where the copies of robots are, asked for in each picture. */
  copyOf?: CopyOf;
  incidents?: readonly Incident[];
  onJump?: (t_s: number) => void;
  /** More buttons, whether they need a robot to be chosen, and what they show of it. */
  tools?: ReactNode;
  needsRobot?: boolean;
  beside?: (robot: SceneDevice, devices: SceneDevice[]) => ReactNode;
}

function hasWebgl(): boolean {
  const canvas = document.createElement("canvas");
  return canvas.getContext("webgl2") !== null;
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

interface CameraBarProps {
  mode: CameraMode;
  onMode: (mode: CameraMode) => void;
  robots: readonly SceneDevice[];
  choosesRobot: boolean;
  follow: string | null;
  onFollow: (robot: string) => void;
  names: boolean;
  onNames: () => void;
  sign: string;
  tools: ReactNode;
}

function CameraBar(props: CameraBarProps) {
  const { t } = useTranslation();
  return (
    <div className={styles.cameraBar}>
      <Segments
        label={t("simulation.cameraMode")}
        segments={MODES.map(({ mode, icon }) => ({ value: mode, words: t(`simulation.${mode}`), icon }))}
        value={props.mode}
        choose={props.onMode}
      />
      {props.choosesRobot && (
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
        {props.sign ? <span className={styles.sign}>{props.sign}</span> : null}
        {props.tools}
        <Toggle pressed={props.names} icon={Tag} onToggle={props.onNames}>
          {t("simulation.labels")}
        </Toggle>
      </span>
    </div>
  );
}

interface ToggleProps {
  pressed: boolean;
  icon: typeof Orbit;
  onToggle: () => void;
  children: string;
}

/** A button of the view that stays pressed. */
export function Toggle({ pressed, icon: Icon, onToggle, children }: ToggleProps) {
  return (
    <button type="button" className={styles.toggle} aria-pressed={pressed} onClick={onToggle}>
      <Icon size={15} aria-hidden /> {children}
    </button>
  );
}

/** Robots go about: where they are is asked of the recording, in each picture. */
const lasting = (device?: SceneDevice) => (device?.kind === "robot" ? { ...device, location: null } : device);
const same = (one: SceneDevice, other?: SceneDevice) => JSON.stringify(lasting(one)) === JSON.stringify(lasting(other));

function placedOf({ id, name, kind, device_class, location, size, radius_m }: Device): SceneDevice {
  return { id, name, kind, device_class, location, size, radius_m: radius_m || USUAL_RADIUS_M };
}

/** Who has a place on the floor: the very same list and devices as before while nothing of them has changed. */
function usePlaced(devices: readonly Device[]): SceneDevice[] {
  const [placed, setPlaced] = useState<SceneDevice[]>([]);
  const now = devices.filter((device) => device.lifecycle === "approved").map(placedOf);
  const kept = now.map((each, index) => (same(each, placed[index]) ? (placed[index] ?? each) : each));
  if (kept.length === placed.length && kept.every((each, index) => each === placed[index])) return placed;
  setPlaced(kept);
  return kept;
}

export function View3D(props: View3DProps) {
  const { t } = useTranslation();
  const { map, devices, recording, moment, t_s, stateOf } = props;
  const [mode, setMode] = useState<CameraMode>("orbit");
  const [follow, setFollow] = useState<string | null>(null);
  const [names, setNames] = useState(true);
  const [webgl] = useState(hasWebgl);
  const placed = usePlaced(devices);
  const robots = placed.filter((device) => device.kind === "robot");
  const followed = robots.find(({ id }) => id === follow) ?? robots[0];
  const summary = robots.map((robot) => `${robot.name} ${stateOf(robot.id)}`.trim()).join(", ");
  return (
    <>
      <CameraBar
        mode={mode}
        onMode={setMode}
        robots={robots}
        choosesRobot={mode === "follow" || mode === "robot" || props.needsRobot === true}
        follow={followed?.id ?? null}
        onFollow={setFollow}
        names={names}
        onNames={() => setNames(!names)}
        sign={props.sign}
        tools={props.tools}
      />
      {webgl && map ? (
        <Suspense fallback={<p className={styles.sceneNote}>{t("simulation.loading")}</p>}>
          <Scene3D
            map={map}
            devices={placed}
            recording={recording}
            moment={moment}
            camera={mode}
            follow={followed?.id ?? null}
            labels={names}
            playing={props.playing}
            filming={props.filming}
            t_s={t_s}
            label={props.labelOf(summary)}
            stateOf={stateOf}
            copyOf={props.copyOf}
            incidents={props.incidents}
            onJump={props.onJump}
          />
        </Suspense>
      ) : (
        <p className={styles.sceneNote}>{t(webgl ? "simulation.loading" : "simulation.noWebgl")}</p>
      )}
      {followed ? props.beside?.(followed, placed) : null}
      <Legend />
    </>
  );
}
