/** The place in 3D as it is now: robots and machines move as they do on the floor. */
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Device, Site, SiteMap } from "@/api/types";
import { useNow } from "@/design/useNow";
import { activityWords } from "@/i18n/activity";
import { formatTime } from "@/i18n/format";
import { liveRobots } from "@/live/robots";
import { useLiveStore } from "@/live/store";
import { View3D } from "@/scene3d/View3D";
import { EVERY_S, LiveRecording, type Seen } from "./liveRecording";
import styles from "./scene.module.css";

interface LiveSceneProps {
  site: Site | undefined;
  map: SiteMap | null;
  devices: readonly Device[];
}

/** How the devices are, by the live store and, where that has not told yet, by what was last known. */
function look(devices: readonly Device[], now_ms: number): Seen {
  const { deviceById } = useLiveStore.getState();
  const robots: Record<string, Seen["robots"][string]> = {};
  const machines: Record<string, boolean> = {};
  for (const known of devices) {
    const device = deviceById[known.id] ?? known;
    const { x, y, theta } = device.location;
    if (device.kind === "robot") robots[device.id] = { pose: [x, y, theta], carrying: device.carrying, route: [] };
    else machines[device.id] = device.status === "busy";
  }
  for (const { id, x, y, theta, route = [] } of liveRobots(now_ms))
    if (robots[id]) robots[id] = { ...robots[id], pose: [x, y, theta], route };
  return { robots, machines };
}

function useLiveRecording(devices: readonly Device[]) {
  const [live] = useState(() => {
    const made = new LiveRecording();
    made.see(performance.now() / 1000, look(devices, performance.now()));
    return made;
  });
  const [recording, setRecording] = useState(live.recording);
  useEffect(() => {
    const see = () => {
      const now_ms = performance.now();
      live.see(now_ms / 1000, look(devices, now_ms));
      setRecording(live.recording);
    };
    see();
    const timer = setInterval(see, EVERY_S * 1000);
    let frame = requestAnimationFrame(function show(now_ms) {
      live.show(now_ms / 1000);
      frame = requestAnimationFrame(show);
    });
    return () => {
      clearInterval(timer);
      cancelAnimationFrame(frame);
    };
  }, [live, devices]);
  return { recording, moment: live.moment };
}

export function LiveScene({ site, map, devices }: LiveSceneProps) {
  const { t } = useTranslation();
  const { recording, moment } = useLiveRecording(devices);
  const now = useNow(1000);
  const stateOf = (id: string) => {
    const device = devices.find((each) => each.id === id);
    if (!device) return "";
    return device.status === "offline" ? t("shell.status.offline") : activityWords(device);
  };
  return (
    <div className={styles.scene}>
      <View3D
        map={map ?? undefined}
        devices={devices}
        recording={recording}
        moment={moment}
        t_s={now / 1000}
        playing
        stateOf={stateOf}
        labelOf={(summary) => t("simulation.sceneLabel", { time: formatTime(new Date(now).toISOString()), summary })}
        sign={site?.simulated ? t("run.simulated") : t("run.scene.live")}
      />
    </div>
  );
}
