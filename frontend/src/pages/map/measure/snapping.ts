/** What the end of a measurement snaps to: where walls begin, and the outlines of machines; pure, metres. */
import { isRobot, type MapDevice } from "@/map/devices/device";
import type { FloorPlan } from "@/map/floor/floor";
import { PIXELS_PER_METRE, type Point } from "@/map/plane/projection";

/** A straight edge by its two ends. */
export type Edge = readonly [Point, Point];

/** How near an edge is snapped to; keys, which aim exactly, snap no farther. */
export const REACH_M = 0.15;
/** As far as a hand misses on the screen. */
const REACH_PX = 12;

/** How near (m) a pointer snaps to an edge of a map that is drawn at this zoom. */
export const reachAt = (zoom: number): number => Math.max(REACH_M, REACH_PX / (zoom * PIXELS_PER_METRE));

/** The nearest point of the edges; the point itself where none is within `reach` metres. */
export function snapped(at: Point, edges: readonly Edge[], reach: number): Point {
  let [best, least] = [at, reach];
  for (const edge of edges) {
    const near = nearestOn(edge, at);
    const far = Math.hypot(near[0] - at[0], near[1] - at[1]);
    if (far <= least) [best, least] = [near, far];
  }
  return best;
}

function nearestOn([[x1, y1], [x2, y2]]: Edge, [x, y]: Point): Point {
  const [dx, dy] = [x2 - x1, y2 - y1];
  const square = dx * dx + dy * dy;
  const along = square > 0 ? ((x - x1) * dx + (y - y1) * dy) / square : 0;
  const share = Math.min(1, Math.max(0, along));
  return [x1 + share * dx, y1 + share * dy];
}

type Cells = Pick<FloorPlan, "width" | "height" | "resolution_m" | "origin" | "cells">;

/** The four sides of a cell: which cell is beyond, and its ends as shares of the cell. */
const SIDES: readonly { readonly beyond: Point; readonly from: Point; readonly to: Point }[] = [
  { beyond: [-1, 0], from: [0, 0], to: [0, 1] },
  { beyond: [1, 0], from: [1, 0], to: [1, 1] },
  { beyond: [0, -1], from: [0, 0], to: [1, 0] },
  { beyond: [0, 1], from: [0, 1], to: [1, 1] },
];

/** The borders between free cells and walls that are within `reach` metres; what is unknown has no border. */
export function wallEdges(plan: Cells, [x, y]: Point, reach: number): Edge[] {
  const { origin, resolution_m: side } = plan;
  const [left, right] = cellsWithin((x - origin.x) / side, reach / side, plan.width);
  const [bottom, top] = cellsWithin((y - origin.y) / side, reach / side, plan.height);
  const edges: Edge[] = [];
  for (let row = bottom; row <= top; row += 1)
    for (let column = left; column <= right; column += 1)
      if (isFree(plan, column, row)) edges.push(...bordersOf(plan, column, row));
  return edges;
}

/** The first and the last cell that may have a border there. */
function cellsWithin(at: number, reach: number, count: number): readonly [number, number] {
  return [Math.max(0, Math.floor(at - reach) - 1), Math.min(count - 1, Math.floor(at + reach) + 1)];
}

function bordersOf(plan: Cells, column: number, row: number): Edge[] {
  const { origin, resolution_m: side } = plan;
  const corner = ([right, up]: Point): Point => [origin.x + (column + right) * side, origin.y + (row + up) * side];
  return SIDES.filter(({ beyond }) => isWall(plan, column + beyond[0], row + beyond[1])).map(({ from, to }) => [
    corner(from),
    corner(to),
  ]);
}

const isFree = (plan: Cells, column: number, row: number): boolean => plan.cells[row * plan.width + column] === 0;

function isWall(plan: Cells, column: number, row: number): boolean {
  if (column < 0 || row < 0 || column >= plan.width || row >= plan.height) return false;
  const cell = plan.cells[row * plan.width + column];
  return cell !== 0 && cell !== 255;
}

/** The sides of all machines whose size is known, as they stand; robots do not stay where they are. */
export function machineEdges(devices: readonly Pick<MapDevice, "kind" | "location" | "size">[]): Edge[] {
  return devices.flatMap((device) => (device.size && !isRobot(device) ? outline(device.location, device.size) : []));
}

function outline({ x, y, theta }: MapDevice["location"], size: { readonly x: number; readonly y: number }): Edge[] {
  const [ahead, aside] = [Math.cos(theta), Math.sin(theta)];
  const corner = (right: number, up: number): Point => {
    const [dx, dy] = [(right * size.x) / 2, (up * size.y) / 2];
    return [x + dx * ahead - dy * aside, y + dx * aside + dy * ahead];
  };
  const [a, b, c, d] = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
  return [
    [a, b],
    [b, c],
    [c, d],
    [d, a],
  ];
}
