/** Devices: what they say of themselves, and what becomes of them. */

import type { Cause, Scalar } from "./values";

export type DeviceStatus = "idle" | "busy" | "done" | "waiting" | "warning" | "error" | "offline" | "pending";

export type Lifecycle = "pending" | "approved" | "retired";

export interface DeviceProperty {
  name: string;
  type: string;
  unit: string;
  minimum: number | null;
  maximum: number | null;
  value: Scalar | null;
}

export interface MethodParameter {
  name: string;
  type: string;
  unit: string;
  minimum: number | null;
  maximum: number | null;
  options: Scalar[] | null;
  required: boolean;
}

export interface DeviceMethod {
  name: string;
  title: string;
  topic: string;
  message_type: string;
  parameters: MethodParameter[];
}

/** What a device is doing, by a code. */
export interface Activity {
  code: string;
  args: Record<string, Scalar | null>;
}

export interface Device {
  id: string;
  name: string;
  kind: "robot" | "machine";
  device_class: string;
  icon: string;
  lifecycle: Lifecycle;
  status: DeviceStatus;
  doing: string;
  activity: Activity | null;
  location: { x: number; y: number; z: number; theta: number };
  size: { x: number; y: number; z: number };
  radius_m: number | null;
  properties: DeviceProperty[];
  methods: DeviceMethod[];
  /** Methods that nobody may call before an admin has confirmed their topics. */
  asks: DeviceMethod[];
  gives: string[];
  takes: string[];
  capacity: number;
  carrying: Record<string, number>;
  last_seen_at: string | null;
  done: boolean;
  simulated: boolean;
  image: string;
  description: string;
  has_key: boolean;
  dropped: number;
}

/** Something that a person told a device to do; `over` once nothing more will come of it. */
export interface MethodCall {
  id: string;
  device: string;
  method: string;
  args: Record<string, unknown>;
  by: string;
  status: "pending" | "sent" | "accepted" | "running" | "done" | "failed" | "rejected" | "cancelled" | "timed_out";
  over: boolean;
  why: string;
  cause: Cause | null;
  result: Record<string, Scalar | null>;
  created_at: string;
  expires_at: string;
  sent_at: string | null;
  ended_at: string | null;
}

/** What a property was; `points` oldest first, the first may lie before `since`. */
export interface Series {
  property: string;
  unit: string;
  since: string;
  bucket_s: number;
  points: { at: string; minimum: number | null; maximum: number | null; value: Scalar | null }[];
}

/** A field of a description that changed; its JSON, empty where it was or is not there. */
export interface FieldChange {
  path: string;
  before: string;
  after: string;
}

export interface DeviceEvent {
  at: string;
  kind: string;
  text: string;
  /** What it is said from; empty for older lines. */
  code: string;
  args: Record<string, unknown>;
  by: string | null;
  changes: FieldChange[];
}
