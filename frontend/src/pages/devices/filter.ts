/** Finding devices: by words, status, kind and what they can do. Pure. */
import type { Device } from "@/api/types";
import { activityWords } from "@/i18n/activity";
import { isShare } from "@/i18n/units";

export interface DeviceFilter {
  readonly query: string;
  readonly status: string | null;
  readonly kind: string | null;
  readonly method: string | null;
}

export const NO_FILTER: DeviceFilter = { query: "", status: null, kind: null, method: null };

/** Approved and waiting ones that fit; those that wait for approval come first. */
export function filterDevices(devices: readonly Device[], filter: DeviceFilter): Device[] {
  const words = filter.query.trim().toLowerCase().split(/\s+/).filter(Boolean);
  return devices
    .filter((device) => device.lifecycle !== "retired")
    .filter((device) => !filter.status || device.status === filter.status)
    .filter((device) => !filter.kind || device.kind === filter.kind)
    .filter((device) => !filter.method || device.methods.some((method) => method.name === filter.method))
    .filter((device) => words.every((word) => textOf(device).includes(word)))
    .sort((a, b) => Number(b.lifecycle === "pending") - Number(a.lifecycle === "pending"));
}

/** Whose approval is asked for: the one that is looked at if it waits for it, the first one otherwise. */
export function pendingOf(devices: readonly Device[], chosen: string | undefined): Device | undefined {
  const waiting = devices.filter((device) => device.lifecycle === "pending");
  return waiting.find((device) => device.id === chosen) ?? waiting[0];
}

function textOf(device: Device): string {
  const methods = device.methods.flatMap((method) => [method.name, method.title, method.topic]);
  return [device.name, device.id, activityWords(device), ...methods].join(" ").toLowerCase();
}

/** Names of all methods, each once, in order of the alphabet. */
export function methodNames(devices: readonly Device[]): string[] {
  return [...new Set(devices.flatMap((device) => device.methods.map((method) => method.name)))].sort();
}

/** Per cent, when the device tells how full its battery is; null where it tells volts. */
export function batteryOf(device: Device): number | null {
  const battery = device.properties.find((property) => property.name === "battery");
  return typeof battery?.value === "number" && isShare(battery.unit) ? battery.value : null;
}

/** 0 to 1 of the job at hand; null when it has none or does not say. */
export function jobOf(device: Device): number | null {
  const value = device.properties.find((property) => property.name === "jobStatus")?.value;
  return typeof value === "number" && device.status === "busy" ? Math.min(1, Math.max(0, value / 100)) : null;
}
