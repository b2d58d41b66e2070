import { Radar } from "lucide-react";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Device, RehearsalResult, SiteMap } from "@/api/types";
import { clock } from "@/design/clock";
import { latest } from "@/scene3d/frames";
import { type Incident, isNow } from "@/scene3d/incidents";
import type { Moment, SceneRecording } from "@/scene3d/types";
import { Toggle, View3D } from "@/scene3d/View3D";
import { ownEntry } from "@/design/ownEntry";
import { Lidar } from "./lidar/Lidar";
import styles from "./SimulationScreen.module.css";

interface ScenePaneProps {
  map: SiteMap | undefined;
  devices: Device[];
  result: RehearsalResult | null;
  moment: Moment;
  t_s: number;
  playing: boolean;
  filming: boolean;
  incidents: readonly Incident[];
  onJump: (t_s: number) => void;
}

/** What is said of each device at the moment: what a robot carries, whether a machine is busy. */
function useStateOf({ result, t_s, incidents }: ScenePaneProps) {
  const { t } = useTranslation();
  const now = incidents.filter((each) => each.kind === "wait" && isNow(each, t_s));
  return (device: string): string => {
    const wait = now.find(({ robot }) => robot === device)?.wait;
    if (wait) return t("simulation.waitsFor", { seconds: Math.round(wait.duration_s) });
    const load = latest(ownEntry(result?.carrying, device), t_s)?.[1] ?? {};
    const carried = Object.entries(load).filter(([, count]) => count > 0);
    if (carried.length > 0) {
      return t("simulation.carries", { load: carried.map(([object, count]) => `${count} × ${object}`).join(", ") });
    }
    return latest(ownEntry(result?.machine_states, device), t_s)?.[1] ? t("simulation.busy") : "";
  };
}

/** A rehearsal's result as the scene reads it. */
function recordingOf(result: RehearsalResult): SceneRecording {
  const routes: SceneRecording["routes"] = {};
  for (const { t, robot, path } of result.routes) (routes[robot] = ownEntry(routes, robot) ?? []).push([t, path]);
  return { ...result, routes };
}

/** A rehearsal in 3D, with what a robot's lidar sees. */
export function ScenePane(props: ScenePaneProps) {
  const { t } = useTranslation();
  const { map, devices, result, moment, t_s } = props;
  const [lidar, setLidar] = useState(false);
  const recording = useMemo(() => result && recordingOf(result), [result]);
  return (
    <section className={`${styles.pane} ${styles.scene}`} aria-label={t("simulation.view3d")} data-scene>
      <View3D
        map={map}
        devices={devices}
        recording={recording}
        moment={moment}
        t_s={t_s}
        playing={props.playing}
        filming={props.filming}
        stateOf={useStateOf(props)}
        labelOf={(summary) => t("simulation.sceneLabel", { time: clock(Math.floor(t_s)), summary })}
        sign={t("simulation.nothingMoves")}
        incidents={props.incidents}
        onJump={props.onJump}
        needsRobot={lidar}
        tools={
          <Toggle pressed={lidar} icon={Radar} onToggle={() => setLidar(!lidar)}>
            {t("simulation.lidar")}
          </Toggle>
        }
        beside={(robot, placed) =>
          lidar && map && result ? (
            <Lidar map={map} devices={placed} frames={result.frames} robot={robot} moment={moment} />
          ) : null
        }
      />
    </section>
  );
}
