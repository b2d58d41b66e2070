/** Devices that have something to do and stand, because their site is stopped: they are told as held. */
import { useMemo } from "react";
import type { Device } from "@/api/types";
import { poseOf, readingsOf, type PosePair } from "./readings";
import { useLiveStore } from "./store";

/** So long a robot's place has not changed when it stands. */
const ROBOT_STILL_MS = 2000;
/** So long a machine's progress has not, or twice as long as it took last time, which may have been a pause. */
const MACHINE_STILL_MS = 10_000;
/** And so long where that was not seen; no machine is waited for any longer. */
const UNKNOWN_STILL_MS = 120_000;
const LOOK_MS = 500;
const DOING = ["driving", "working", "working_percent"];

let timer: ReturnType<typeof setTimeout> | undefined;
const told = new WeakMap<Device, Device>();

/** Whether a robot with these last two poses stands. */
export function standsAt(pose: PosePair | undefined, now: number): boolean {
  return !pose?.previous || now - pose.current.at >= ROBOT_STILL_MS;
}

/** Whether a device is seen to stand; of a machine that tells no progress nobody knows. */
function isStill({ id, kind, properties }: Device, now: number): boolean {
  if (kind === "robot") return standsAt(poseOf(id), now);
  if (typeof properties.find(({ name }) => name === "jobStatus")?.value !== "number") return false;
  const seen = readingsOf(id, "jobStatus").filter(({ value }, at, all) => value !== all[at - 1]?.value);
  const [before, last] = [seen.at(-2), seen.at(-1)];
  if (!last) return false;
  const pace = before ? Math.max(MACHINE_STILL_MS, 2 * (last.at - before.at)) : UNKNOWN_STILL_MS;
  return now - last.at >= Math.min(pace, UNKNOWN_STILL_MS);
}

/** Look who stands, and again while anybody who has something to do still moves. */
function look(): void {
  clearTimeout(timer);
  const { stop, deviceById, held } = useLiveStore.getState();
  const busy = stop?.active ? Object.values(deviceById).filter(({ status }) => status === "busy") : [];
  const still = busy.filter((device) => isStill(device, performance.now())).map(({ id }) => id);
  if (still.join() !== held.join()) useLiveStore.setState({ held: still });
  if (still.length < busy.length) timer = setTimeout(look, LOOK_MS);
}

useLiveStore.subscribe((state, before) => {
  if (state.stop !== before.stop || state.deviceById !== before.deviceById) look();
});
look(); // of pages that need this late, such as the dialog of a stop

/** One that is held waits, whatever it has told of its work. */
export function heldOf<D extends Pick<Device, "status" | "activity">>(device: D): D {
  const isDoing = device.activity && DOING.includes(device.activity.code);
  return { ...device, status: "waiting", ...(isDoing ? { activity: { code: "held", args: {} } } : null) };
}

/** A device as screens tell it. */
export function asHeld(device: Device, held: readonly string[]): Device {
  if (device.status !== "busy" || !held.includes(device.id)) return device;
  let waits = told.get(device);
  if (!waits) {
    waits = heldOf(device);
    told.set(device, waits);
  }
  return waits;
}

/** Devices of the site that is looked at, as screens tell them. */
export function useAsHeld(devices: Device[] | undefined): Device[] | undefined {
  const held = useLiveStore((state) => state.held);
  return useMemo(() => (held.length > 0 ? devices?.map((each) => asHeld(each, held)) : devices), [devices, held]);
}
