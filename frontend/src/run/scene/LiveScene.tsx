/** The place in 3D as it is now: robots and machines move as they do on the floor. */
import { useReducedMotion } from "@mantine/hooks";
import type { TFunction } from "i18next";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Device, SiteMap } from "@/api/types";
import { useNow } from "@/design/useNow";
import { activityWords } from "@/i18n/activity";
import { formatNumber, formatTime, withUnit } from "@/i18n/format";
import { asHeld } from "@/live/held";
import { poseOf } from "@/live/readings";
import { liveRobots } from "@/live/robots";
import { useLiveStore } from "@/live/store";
import { apartOf } from "@/map/robots/robots";
import { View3D } from "@/scene3d/View3D";
import { ownEntry } from "@/design/ownEntry";
import { EVERY_S, LiveRecording, type Seen } from "./liveRecording";
import styles from "./scene.module.css";

interface LiveSceneProps {
  map: SiteMap | null;
  devices: readonly Device[];
}

/** How the devices are, by the live store and, where that has not told yet, by what was last known. */
function look(devices: readonly Device[], now_ms: number): Seen {
  const { deviceById, held } = useLiveStore.getState();
  const robots: Record<string, Seen["robots"][string]> = {};
  const machines: Record<string, boolean> = {};
  for (const known of devices) {
    const device = asHeld(ownEntry(deviceById, known.id) ?? known, held);
    const { x, y, theta } = device.location;
    if (device.kind === "robot") robots[device.id] = { pose: [x, y, theta], carrying: device.carrying, route: [] };
    else machines[device.id] = device.status === "busy";
  }
  for (const { id, x, y, theta, route = [] } of liveRobots(now_ms)) {
    const robot = ownEntry(robots, id);
    if (robot) robots[id] = { ...robot, pose: [x, y, theta], route };
  }
  return { robots, machines };
}

/** Grows as long as the scene is shown; nothing is drawn anew by React for it. */
function useLiveRecording(devices: readonly Device[]): { live: LiveRecording; lively: boolean } {
  const known = useRef(devices);
  useEffect(() => {
    known.current = devices;
  }, [devices]);
  const [live] = useState(() => {
    const made = new LiveRecording();
    made.see(performance.now() / 1000, look(devices, performance.now()));
    return made;
  });
  const [lively, setLively] = useState(true);
  useEffect(() => {
    let copied_s = 0;
    let copies = useLiveStore.getState().copies;
    const timer = setInterval(() => {
      const now_ms = performance.now();
      live.see(now_ms / 1000, look(known.current, now_ms));
      if (copies !== useLiveStore.getState().copies) copied_s = now_ms / 1000;
      copies = useLiveStore.getState().copies;
      setLively(live.isLively(now_ms / 1000) || now_ms / 1000 - copied_s < 1);
    }, EVERY_S * 1000);
    let frame = requestAnimationFrame(function show(now_ms) {
      live.show(now_ms / 1000);
      frame = requestAnimationFrame(show);
    });
    return () => {
      clearInterval(timer);
      cancelAnimationFrame(frame);
    };
  }, [live]);
  return { live, lively };
}

const copyOf = (robot: string) => ownEntry(useLiveStore.getState().copies, robot);

/** Of each robot that is not where its copy is, how far that is, in words. */
function copiesApart(devices: readonly Device[], t: TFunction): string[] {
  return devices.flatMap((device) => {
    const copy = copyOf(device.id);
    const apart = copy ? apartOf(copy, poseOf(device.id)?.current ?? device.location) : null;
    if (apart === null) return [];
    return [t("run.scene.copyApart", { name: device.name, apart: withUnit(formatNumber(apart, 1), "m") })];
  });
}

/** Whether nothing, all or some of what is seen is simulated. */
function kindOf(devices: readonly Device[]): "live" | "simulated" | "mixed" {
  const approved = devices.filter((device) => device.lifecycle === "approved");
  if (!approved.some(isSimulated)) return "live";
  return approved.every(isSimulated) ? "simulated" : "mixed";
}

/** By itself, or because something simulated speaks in its place. */
const isSimulated = (device: Device) => device.simulated || device.stand_in;

export function LiveScene({ map, devices }: LiveSceneProps) {
  const { t } = useTranslation();
  const { live, lively } = useLiveRecording(devices);
  const { recording, moment } = live;
  const kind = kindOf(devices);
  const now = useNow(1000);
  const still = useReducedMotion();
  const stateOf = (id: string) => {
    const device = devices.find((each) => each.id === id);
    if (!device) return "";
    const doing = device.status === "offline" ? t("shell.status.offline") : activityWords(device);
    return kind === "mixed" && device.simulated ? t("run.scene.ofSimulated", { doing }) : doing;
  };
  const withCopies = (summary: string) => [summary, ...copiesApart(devices, t)].join(", ");
  return (
    <div className={styles.scene} data-scene>
      <View3D
        map={map ?? undefined}
        devices={devices}
        recording={recording}
        moment={moment}
        t_s={now / 1000}
        playing={lively && !still} // else drawn anew with each second that is shown, as maps are
        stateOf={stateOf}
        copyOf={copyOf}
        labelOf={(summary) => {
          const time = formatTime(new Date(now).toISOString());
          return t("simulation.sceneLabel", { time, summary: withCopies(summary) });
        }}
        sign={t(`run.scene.${kind}`)}
      />
    </div>
  );
}
