/** What a lidar would see from a robot's place: rays over the map's walls, machines' outlines and other robots. Pure. */
import type { PoseFrame } from "@/scene3d/frames";
import type { SceneDevice, SceneMap } from "@/scene3d/types";

const OCCUPIED = 100;
export const RAYS = 240;
export const RANGE_M = 8;

export interface Round {
  readonly x: number;
  readonly y: number;
  readonly radius_m: number;
}

type Segment = readonly [x1: number, y1: number, x2: number, y2: number];

/** The outlines of machines, as lines in metres. */
export function outlinesOf(machines: readonly SceneDevice[]): Segment[] {
  return machines.flatMap(({ location: { x, y, theta }, size }) => {
    const [cos, sin] = [Math.cos(theta), Math.sin(theta)];
    const corners = [
      [1, 1],
      [-1, 1],
      [-1, -1],
      [1, -1],
    ].map(([a = 0, b = 0]) => {
      const [u, v] = [(a * size.x) / 2, (b * size.y) / 2];
      return [x + u * cos - v * sin, y + u * sin + v * cos] as const;
    });
    return corners.map(([x1, y1], at): Segment => {
      const [x2, y2] = corners[(at + 1) % 4] ?? [x1, y1];
      return [x1, y1, x2, y2];
    });
  });
}

/** How far each ray reaches (m), anticlockwise from where the robot looks; `Infinity`: nothing in range. */
export function scan(
  map: SceneMap,
  [x, y, theta]: PoseFrame,
  outlines: readonly Segment[],
  others: readonly Round[],
  rays = RAYS,
): number[] {
  return Array.from({ length: rays }, (_, ray) => {
    const angle = theta + (ray / rays) * 2 * Math.PI;
    const [dx, dy] = [Math.cos(angle), Math.sin(angle)];
    const far = Math.min(
      toWall(map, x, y, dx, dy),
      ...outlines.map((line) => toLine(line, x, y, dx, dy)),
      ...others.map((other) => toRound(other, x, y, dx, dy)),
    );
    return far <= RANGE_M ? far : Infinity;
  });
}

/** From cell to cell until one is a wall. */
function toWall(map: SceneMap, x: number, y: number, dx: number, dy: number): number {
  const side = map.resolution_m;
  let column = Math.floor((x - map.origin.x) / side);
  let row = Math.floor((y - map.origin.y) / side);
  const [right, up] = [dx > 0 ? 1 : -1, dy > 0 ? 1 : -1];
  const edge = (cell: number, step: number) => (cell + (step > 0 ? 1 : 0)) * side;
  let nextX = dx === 0 ? Infinity : (map.origin.x + edge(column, right) - x) / dx;
  let nextY = dy === 0 ? Infinity : (map.origin.y + edge(row, up) - y) / dy;
  let far = 0;
  while (far <= RANGE_M && column >= 0 && row >= 0 && column < map.width && row < map.height) {
    if (map.cells[row * map.width + column] === OCCUPIED) return far;
    far = Math.min(nextX, nextY);
    if (nextX < nextY) {
      column += right;
      nextX += side / Math.abs(dx);
    } else {
      row += up;
      nextY += side / Math.abs(dy);
    }
  }
  return Infinity;
}

function toLine([x1, y1, x2, y2]: Segment, x: number, y: number, dx: number, dy: number): number {
  const [ex, ey] = [x2 - x1, y2 - y1];
  const cross = dx * ey - dy * ex;
  if (Math.abs(cross) < 1e-12) return Infinity;
  const far = ((x1 - x) * ey - (y1 - y) * ex) / cross;
  const along = ((x1 - x) * dy - (y1 - y) * dx) / cross;
  return far > 0 && along >= 0 && along <= 1 ? far : Infinity;
}

function toRound({ x: cx, y: cy, radius_m }: Round, x: number, y: number, dx: number, dy: number): number {
  const along = (cx - x) * dx + (cy - y) * dy;
  const off = (cx - x) ** 2 + (cy - y) ** 2 - along ** 2;
  if (along <= 0 || off > radius_m ** 2) return Infinity;
  return along - Math.sqrt(radius_m ** 2 - off);
}
