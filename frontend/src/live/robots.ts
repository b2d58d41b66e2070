/** The live robots of a site as the map's robot layer asks for them, once a frame. */
import { activityWords } from "@/i18n/activity";
import { waitWords } from "@/i18n/waits";
import { statusOf } from "@/map/devices/device";
import { interpolatePose, type RobotSource, type RobotView } from "@/map/robots/robots";
import { ownEntry } from "@/design/ownEntry";
import { asHeld } from "./held";
import { poseOf } from "./readings";
import { useLiveStore } from "./store";

/** What was told last, and of what: several layers ask in the same frame. */
let told: { now: number; of: unknown; views: readonly RobotView[] } = { now: -1, of: null, views: [] };

/** Reads the live store as it is at each frame; nothing subscribes. */
export const liveRobots: RobotSource = (now) => {
  const store = useLiveStore.getState();
  if (told.now !== now || told.of !== store) told = { now, of: store, views: read(now, store) };
  return told.views;
};

function read(
  now: number,
  { deviceById, traffic, copies, held }: ReturnType<typeof useLiveStore.getState>,
): RobotView[] {
  const views: RobotView[] = [];
  for (const known of Object.values(deviceById)) {
    if (known.kind !== "robot") continue;
    const device = asHeld(known, held);
    const pair = poseOf(device.id);
    const pose = pair ? interpolatePose(pair.previous, pair.current, now) : device.location;
    const path = ownEntry(traffic, device.id);
    views.push({
      id: device.id,
      name: device.name,
      status: statusOf(device),
      note: activityWords(device) || undefined,
      carrying: Object.values(device.carrying).some((count) => count > 0),
      x: pose.x,
      y: pose.y,
      theta: pose.theta,
      copy: ownEntry(copies, device.id),
      real: device.stands_at,
      route: path?.route,
      reserved: path?.reserved,
      wait: waitWords(path?.why, (id) => ownEntry(deviceById, id)?.name ?? id) ?? path?.wait ?? null,
    });
  }
  return views;
}
