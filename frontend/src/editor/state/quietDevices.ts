/** Devices without their restlessness: the same list until something changes that the drawing shows. */
import { useRef } from "react";
import type { Device } from "@/api/types";
import { doingWords } from "@/i18n/doing";
import { isRobot, progressOf } from "@/map/device";

export function useQuietDevices(devices: Device[]): readonly Device[] {
  const kept = useRef<{ print: string; devices: readonly Device[] }>({ print: "", devices: [] });
  const print = JSON.stringify(devices.map(lookOf));
  if (kept.current.print !== print) kept.current = { print, devices };
  return kept.current.devices;
}

/** Robots are drawn from their live poses, so theirs do not count here. */
function lookOf(device: Device): unknown[] {
  const { x, y, theta } = device.location;
  const progress = progressOf(device);
  return [
    device.id,
    device.name,
    device.status,
    device.lifecycle,
    isRobot(device) ? null : [x, y, theta, doingWords(device)],
    progress === null ? null : Math.round(progress * 20),
    device.methods.length,
    device.gives,
    device.takes,
  ];
}
