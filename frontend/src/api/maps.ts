/** The floor of a site, and the ways on it. */

import type { Point, WaitReason } from "./values";

export interface MapPlace {
  id: string;
  name: string;
  kind: string;
  x: number;
  y: number;
  theta: number;
}

export interface SiteMapInfo {
  version: number;
  width: number;
  height: number;
  resolution_m: number;
  origin: { x: number; y: number; yaw: number };
  places: MapPlace[];
  walls: [number, number, number, number][];
}

/** A map with its cells: row by row from the bottom row, 0 free, 100 wall, 255 unknown. */
export interface SiteMap extends SiteMapInfo {
  cells: Uint8Array;
}

export interface RouteAnswer {
  path: Point[];
  length_m: number;
  seconds: number;
}

export interface RobotTraffic {
  route: Point[];
  reserved: Point[];
  wait: string | null;
  why?: WaitReason | null;
}
