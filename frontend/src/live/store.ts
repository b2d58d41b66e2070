/** What changes often at the site that is being looked at; select narrowly. */
import { create } from "zustand";
import type { Device, SiteStop } from "@/api/types";
import type { LineState } from "./connection";
import type { CopyPose, RobotTraffic } from "./messages";

/** `refused`: the server tells this person nothing of the site any more, and is not asked again. */
export type Connection = LineState | "refused";

/** What a run tells people; `id` counts them in this browser. */
export interface Notice {
  id: number;
  run: string;
  text: string;
  level: "info" | "warning";
  /** What of VIPO's own it says; empty: the program's words. */
  code: string;
  args: Readonly<Record<string, unknown>>;
}

export interface LiveState {
  site: string | null;
  connection: Connection;
  /** When the connection was lost, milliseconds since 1970; null while it stands. */
  lostAt: number | null;
  deviceById: Record<string, Device>;
  traffic: Record<string, RobotTraffic>;
  /** The mirror's copies of robots at work, by their ids. */
  copies: Readonly<Record<string, CopyPose>>;
  stop: SiteStop | null;
  /** Who has something to do and stands, while the site is stopped. */
  held: readonly string[];
  /** The last ones, oldest first. */
  notices: readonly Notice[];
}

export const EMPTY: LiveState = {
  site: null,
  connection: "connecting",
  lostAt: null,
  deviceById: {},
  traffic: {},
  copies: {},
  stop: null,
  held: [],
  notices: [],
};

export const useLiveStore = create<LiveState>(() => EMPTY);

/** Whether a site is the one that is looked at. */
export const isLookedAt = (slug: string): boolean => useLiveStore.getState().site === slug;

/** Change what is known of a site while it is looked at: news of another are none of its. */
export function setLive(slug: string, change: Partial<LiveState>): void {
  if (isLookedAt(slug)) useLiveStore.setState(change);
}
