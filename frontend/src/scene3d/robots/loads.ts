/** What robots carry, as the scene draws it. Pure. */
import { ownEntry } from "@/design/ownEntry";
import { latest } from "../frames";
import type { SceneRecording } from "../types";

export type LoadShape = "box" | "can";

/** What is seen on top of a robot at a moment; null when it carries nothing. */
export function loadAt(recording: SceneRecording, robot: string, t_s: number): LoadShape | null {
  const carried = latest(ownEntry(recording.carrying, robot), t_s)?.[1];
  if (!carried) return null;
  let shape: LoadShape | null = null;
  for (const object of Object.keys(carried)) {
    if (!((carried[object] ?? 0) > 0)) continue;
    if (object.toLowerCase().includes("can")) return "can";
    shape = "box";
  }
  return shape;
}
