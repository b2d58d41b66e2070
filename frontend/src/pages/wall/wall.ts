/** What `/ws/wall` says, and what a wall screen knows by it; pure but for unpacking the map's cells. */
import type { Activity, DeviceStatus, RunStatus, WaitReason } from "@/api/types";
import type { MapDevice } from "@/map/devices/device";
import type { FloorPlan } from "@/map/floor/floor";

export interface WallDevice extends Omit<MapDevice, "doing"> {
  readonly icon: string;
  readonly status: DeviceStatus;
  readonly done: boolean;
  readonly activity: Activity | null;
}

export interface WallRun {
  readonly number: number;
  readonly program: string;
  readonly status: RunStatus;
  readonly started_at: string | null;
  readonly not_before: string | null;
  readonly done: number;
  readonly total: number;
  readonly wait: WaitReason | null;
}

export interface WallAlert {
  readonly id: number;
  readonly device: string;
  readonly code: string;
  readonly severity: "info" | "warning" | "error";
  readonly count: number;
  readonly state: string;
  readonly first_at: string;
  readonly last_at: string;
}

export interface Picture {
  readonly site: string;
  readonly stop: { readonly active: boolean; readonly at: string | null };
  readonly devices: readonly WallDevice[];
  readonly runs: readonly WallRun[];
  readonly alerts: readonly WallAlert[];
  readonly more_alerts: number;
}

/** A map as it is sent: its cells deflated (zlib) and in base64. */
export type PackedMap = Omit<FloorPlan, "cells"> & { readonly cells: string };

export type WallMessage =
  | { readonly type: "beat" }
  | ({ readonly type: "map" } & PackedMap)
  | ({ readonly type: "picture" } & Picture)
  | { readonly type: "devices"; readonly devices: readonly (Partial<WallDevice> & { id: string })[] };

/** The picture after a message; those about the map change nothing of it. */
export function applyMessage(picture: Picture | null, message: WallMessage): Picture | null {
  if (message.type === "picture") return message;
  if (message.type !== "devices" || !picture) return picture;
  const changes = new Map(message.devices.map((change) => [change.id, change]));
  const devices = picture.devices.map((device) => ({ ...device, ...changes.get(device.id) }));
  return { ...picture, devices };
}

export async function unpackMap({ cells, ...map }: PackedMap): Promise<FloorPlan> {
  const packed = Uint8Array.from(atob(cells), (letter) => letter.charCodeAt(0));
  const inflated = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return { ...map, cells: new Uint8Array(await new Response(inflated).arrayBuffer()) };
}

/** How many devices are there, of how many. */
export function countOnline(devices: readonly WallDevice[]): { online: number; all: number } {
  return { online: devices.filter((device) => device.status !== "offline").length, all: devices.length };
}

/** The code behind the sign # of a link, empty where the address has none. */
export function codeOf(hash: string): string {
  return hash.startsWith("#") ? hash.slice(1) : hash;
}
