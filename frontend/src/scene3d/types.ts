import type { FloorPlan } from "@/map/floor/floor";
import type { Frames } from "./frames";

export type SceneMap = FloorPlan;

export interface SceneDevice {
  id: string;
  name: string;
  kind: "machine" | "robot";
  device_class: string;
  location: { x: number; y: number; theta: number };
  size: { x: number; y: number; z: number };
  radius_m: number;
}

/** What the recording says of the moments in it. */
export interface SceneRecording {
  frames: Frames;
  carrying: Record<string, [number, Record<string, number>][]>;
  machine_states: Record<string, [number, boolean][]>;
  /** By robot, the paths that it was given and when. */
  routes: Record<string, [number, readonly (readonly [number, number])[]][]>;
}

/** The moment that is shown, changed many times a second without drawing React anew. */
export interface Moment {
  t_s: number;
}

/** Where the copy of a robot is now, if it has one. */
export type CopyOf = (robot: string) => { readonly x: number; readonly y: number } | undefined;

export type CameraMode = "orbit" | "top" | "follow" | "robot";
