/** A parallel view onto the floor from above and the side; metres in, drawing units out. Pure. */
import type { Device, SiteMap } from "@/api/types";
import { mergeCells } from "@/map/floor/floor";

export type Corner = readonly [x: number, y: number, z: number];
export interface Block {
  readonly key: string;
  /** Left, bottom, right, top on the floor, metres. */
  readonly box: readonly [number, number, number, number];
  readonly height: number;
  readonly kind: "wall" | "machine" | "robot";
  readonly device?: Device;
}

const TURN = (24 * Math.PI) / 180;
const TILT = (50 * Math.PI) / 180;
const LONGEST_WALL_M = 1.2;
const WALL_HEIGHT_M = 0.9;

/** Where a point is drawn; x right, y down. */
export function project([x, y, z]: Corner): [number, number] {
  const across = x * Math.cos(TURN) - y * Math.sin(TURN);
  const along = x * Math.sin(TURN) + y * Math.cos(TURN);
  return [across, -along * Math.sin(TILT) - z * Math.cos(TILT)];
}

/** How far from the eye: the greater, the farther. */
export function depth([left, bottom, right, top]: Block["box"]): number {
  return ((left + right) / 2) * Math.sin(TURN) + ((bottom + top) / 2) * Math.cos(TURN);
}

/** Cut a long wall into short ones, so that what stands nearer can be drawn after it. */
export function cutWall(box: Block["box"]): Block["box"][] {
  const [left, bottom, right, top] = box;
  const pieces = Math.ceil(Math.max(right - left, top - bottom) / LONGEST_WALL_M);
  return Array.from({ length: pieces }, (_, index) => {
    const [from, to] = [index / pieces, (index + 1) / pieces];
    return right - left > top - bottom
      ? [left + (right - left) * from, bottom, left + (right - left) * to, top]
      : [left, bottom + (top - bottom) * from, right, bottom + (top - bottom) * to];
  });
}

/** The floor that is known to be free, as boxes in metres. */
export function floorBoxes(map: SiteMap): Block["box"][] {
  return mergeCells(map, (cell) => cell !== 255).map((box) => {
    const left = map.origin.x + box.column * map.resolution_m;
    const bottom = map.origin.y + box.row * map.resolution_m;
    return [left, bottom, left + box.columns * map.resolution_m, bottom + box.rows * map.resolution_m];
  });
}

function bodyOf(device: Device): Block {
  const { x, y, theta } = device.location;
  const key = device.id;
  if (device.kind === "robot")
    return { key, box: [x - 0.3, y - 0.3, x + 0.3, y + 0.3], height: 0.4, kind: "robot", device };
  const turned = Math.abs(Math.sin(theta)) > 0.7;
  const [across, along] = turned ? [device.size.y, device.size.x] : [device.size.x, device.size.y];
  const [half, deep] = [Math.max(0.9, across) / 2, Math.max(0.9, along) / 2];
  return { key, box: [x - half, y - deep, x + half, y + deep], height: 0.75, kind: "machine", device };
}

/** The walls, in short pieces. */
export function wallBlocks(map: SiteMap): Block[] {
  const pieces = map.walls.flatMap(cutWall);
  return pieces.map((box, index) => ({ key: `wall ${index}`, box, height: WALL_HEIGHT_M, kind: "wall" }));
}

/** Everything that stands on the floor, the farthest first. */
export function blocksOf(walls: readonly Block[], devices: readonly Device[]): Block[] {
  const bodies = devices.filter((device) => device.lifecycle === "approved").map(bodyOf);
  return [...walls, ...bodies].sort((a, b) => depth(b.box) - depth(a.box));
}

/** Equal for devices that look the same in the picture: readings change all the time, their places to 0.1 m do not. */
export function lookOf(devices: readonly Device[]): string {
  return JSON.stringify(
    devices.map(({ id, lifecycle, status, device_class, location: { x, y, theta }, size }) => {
      const turned = Math.abs(Math.sin(theta)) > 0.7;
      return [id, lifecycle, status, device_class, Math.round(x * 10), Math.round(y * 10), turned, size.x, size.y];
    }),
  );
}
