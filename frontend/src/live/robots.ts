/** The live robots of a site as the map's robot layer asks for them, once a frame. */
import { activityWords } from "@/i18n/activity";
import { waitWords } from "@/i18n/waits";
import { statusOf } from "@/map/devices/device";
import { interpolatePose, type RobotSource, type RobotView } from "@/map/robots/robots";
import { poseOf } from "./readings";
import { useLiveStore } from "./store";

/** Reads the live store as it is at each frame; nothing subscribes. */
export const liveRobots: RobotSource = (now) => {
  const { deviceById, traffic, copies } = useLiveStore.getState();
  const views: RobotView[] = [];
  for (const device of Object.values(deviceById)) {
    if (device.kind !== "robot") continue;
    const pair = poseOf(device.id);
    const pose = pair ? interpolatePose(pair.previous, pair.current, now) : device.location;
    const path = traffic[device.id];
    views.push({
      id: device.id,
      name: device.name,
      status: statusOf(device),
      note: activityWords(device) || undefined,
      carrying: Object.values(device.carrying).some((count) => count > 0),
      x: pose.x,
      y: pose.y,
      theta: pose.theta,
      copy: copies[device.id],
      real: device.stands_at,
      route: path?.route,
      reserved: path?.reserved,
      wait: waitWords(path?.why, (id) => deviceById[id]?.name ?? id) ?? path?.wait ?? null,
    });
  }
  return views;
};
