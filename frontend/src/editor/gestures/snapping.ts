/** Where a chip that is let go stands: at a port, in line with another chip, on the grid. Drawing pixels; pure. */
import { PIXELS_PER_METRE, type Box } from "@/map/projection";
import type { PixelPoint } from "@/map/routePath";

/** Pixels of the screen. */
const PORT_REACH = 24;
const LINE_REACH = 12;
const GRID = PIXELS_PER_METRE / 2;

export interface Guide {
  readonly from: PixelPoint;
  readonly to: PixelPoint;
}

export interface Snapped {
  readonly at: PixelPoint;
  readonly guides: readonly Guide[];
}

export interface SnapTargets {
  readonly ports: readonly PixelPoint[];
  /** The middles of the other chips. */
  readonly centres: readonly PixelPoint[];
}

/** The middles of a machine's four sides. */
export function portsOf(box: Box): PixelPoint[] {
  const [x, y] = [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
  return [
    { x, y: box.top },
    { x: box.right, y },
    { x, y: box.bottom },
    { x: box.left, y },
  ];
}

export function snap(at: PixelPoint, targets: SnapTargets, zoom: number): Snapped {
  const port = nearest(targets.ports, (each) => Math.hypot(each.x - at.x, each.y - at.y), PORT_REACH / zoom);
  if (port) return { at: port, guides: [] };
  const above = nearest(targets.centres, (each) => Math.abs(each.x - at.x), LINE_REACH / zoom);
  const beside = nearest(targets.centres, (each) => Math.abs(each.y - at.y), LINE_REACH / zoom);
  const to = { x: above?.x ?? onGrid(at.x), y: beside?.y ?? onGrid(at.y) };
  return { at: to, guides: [above, beside].flatMap((from) => (from ? [{ from, to }] : [])) };
}

function nearest(
  points: readonly PixelPoint[],
  far: (point: PixelPoint) => number,
  reach: number,
): PixelPoint | undefined {
  return points.filter((point) => far(point) <= reach).sort((one, other) => far(one) - far(other))[0];
}

function onGrid(value: number): number {
  return Math.round(value / GRID) * GRID;
}
