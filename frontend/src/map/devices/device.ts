/** What a map needs to know about a device, and how a status looks. */
import type { Activity, DeviceStatus } from "@/api/types";
import { PIXELS_PER_METRE } from "../plane/projection";

export type { DeviceStatus };

export interface MapDevice {
  readonly id: string;
  readonly name: string;
  readonly kind: string;
  readonly device_class: string;
  readonly status: string;
  readonly doing: string;
  readonly activity?: Activity | null;
  readonly stand_in?: boolean;
  readonly location: { readonly x: number; readonly y: number; readonly theta: number };
  readonly size: { readonly x: number; readonly y: number } | null;
  readonly properties: readonly { readonly name: string; readonly value: unknown }[];
}

export interface Ring {
  readonly colour: string;
  readonly width: number;
  readonly dash?: string;
  readonly double?: boolean;
}

const RINGS: Readonly<Record<DeviceStatus, Ring>> = {
  idle: { colour: "var(--idle)", width: 1.6 },
  busy: { colour: "var(--busy)", width: 3.2 },
  done: { colour: "var(--done)", width: 2.6 },
  waiting: { colour: "var(--warn)", width: 2.2, dash: "7 4" },
  warning: { colour: "var(--idle)", width: 1.6 },
  error: { colour: "var(--error)", width: 2.2, double: true },
  offline: { colour: "var(--offline)", width: 1.6, dash: "2 3.2" },
  pending: { colour: "var(--pend)", width: 2.2, dash: "0.1 4.4" },
};

export function statusOf(device: { readonly status: string }): DeviceStatus {
  return Object.hasOwn(RINGS, device.status) ? (device.status as DeviceStatus) : "idle";
}

export function ringOf(status: DeviceStatus): Ring {
  return RINGS[status];
}

/** 0 to 1 of the job at hand, from the property `jobStatus` (per cent) where the device has it. */
export function progressOf(device: MapDevice): number | null {
  const property = device.properties.find((each) => each.name === "jobStatus");
  if (typeof property?.value !== "number") return null;
  return Math.min(1, Math.max(0, property.value / 100));
}

export function isRobot(device: { readonly kind: string }): boolean {
  return device.kind === "robot";
}

/** Width and height of a device's outline in drawing pixels as it stands, turned by quarter turns. */
export function footprint(device: MapDevice): { width: number; height: number } {
  if (isRobot(device)) return { width: 44, height: 44 };
  const across = Math.max(0.9, device.size?.x ?? 1.2) * PIXELS_PER_METRE;
  const along = Math.max(0.9, device.size?.y ?? 1.2) * PIXELS_PER_METRE;
  const turned = Math.abs(Math.sin(device.location.theta)) > 0.7;
  return turned ? { width: along, height: across } : { width: across, height: along };
}
