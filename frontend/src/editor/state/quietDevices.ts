/** The devices of an open program, which change when something of them does that is drawn, chosen or checked. */
import { useRef } from "react";
import type { Device } from "@/api/types";
import { activityWords } from "@/i18n/activity";
import { isRobot, progressOf } from "@/map/devices/device";

/** The same array for as long as devices only move about and tell readings. */
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
    device.status,
    device.lifecycle,
    isRobot(device) ? null : [x, y, theta, activityWords(device)],
    progress === null ? null : Math.round(progress * 20),
    saidBy(device),
  ];
}

const SAID = new WeakMap<Device, string>();

/** What its description says, written once for each answer of the server about the device. */
function saidBy(device: Device): string {
  let said = SAID.get(device);
  if (said === undefined) {
    const { id, name, kind, device_class, description, icon, image, size, radius_m, capacity } = device;
    const { gives, takes, methods, asks, stand_in } = device;
    const properties = device.properties.map((property) => ({ ...property, value: null }));
    const plain = [id, name, kind, device_class, description, icon, image, size, radius_m, capacity];
    said = JSON.stringify([...plain, gives, takes, methods, asks, stand_in, properties]);
    SAID.set(device, said);
  }
  return said;
}
