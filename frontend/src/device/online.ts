/** Whether a device can be heard. */
import type { Device } from "@/api/types";

/** A device that says nothing for so long counts as offline. */
const SILENT_MS = 45_000;

/** Whether it talks: of one that waits for approval only what it said last tells that. */
export function isOnline(device: Device, now: number): boolean {
  if (device.lifecycle !== "pending") return device.status !== "offline";
  return device.last_seen_at !== null && now - Date.parse(device.last_seen_at) < SILENT_MS;
}
