/** Where a chip that is let go stands: at a port, in line with another chip, on the grid. Drawing pixels; pure. */
import { useCallback, useMemo, useRef } from "react";
import { isRobot } from "@/map/devices/device";
import type { PixelPoint } from "@/map/plane/paths";
import { type Box, PIXELS_PER_METRE } from "@/map/plane/projection";
import type { ViewportCell } from "@/map/plane/viewport";
import { grown } from "../scene/geometry";
import type { Scene } from "../scene/scene";
import { deviceBox, type SiteDevice } from "../surroundings";

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

export interface Snapping {
  readonly snapTo: (id: string, at: PixelPoint) => Snapped;
  /** Hears whether Alt is held. */
  readonly watch: (event: { readonly altKey: boolean }) => void;
}

export function useSnapping(scene: Scene, devices: readonly SiteDevice[], viewport: ViewportCell): Snapping {
  const free = useRef(false);
  const ports = useMemo(
    () => devices.filter((device) => !isRobot(device)).flatMap((each) => portsOf(deviceBox(each))),
    [devices],
  );
  const centres = useMemo(() => [...scene.chips.values()].map((chip) => chip.at), [scene]);
  const snapTo = useCallback(
    (id: string, at: PixelPoint) => {
      if (free.current) return { at, guides: [] };
      const own = scene.chips.get(id)?.at;
      return snap(at, { ports, centres: centres.filter((each) => each !== own) }, viewport.get().zoom);
    },
    [scene, centres, ports, viewport],
  );
  const watch = useCallback((event: { readonly altKey: boolean }) => {
    free.current = event.altKey;
  }, []);
  return { snapTo, watch };
}

/** Pixels of the screen. */
const DOT_REACH = 24;

/** The step within reach of the pointer, the nearest of several. */
export function joinTarget(chips: Scene["chips"], from: string, point: PixelPoint, zoom: number): string | null {
  const near = [...chips.values()]
    .filter((chip) => chip.id !== from && inside(grown(chip.box, DOT_REACH / zoom), point))
    .map((chip) => ({ id: chip.id, far: Math.hypot(chip.at.x - point.x, chip.at.y - point.y) }));
  return near.sort((one, other) => one.far - other.far)[0]?.id ?? null;
}

/** Where a pointer or a finger was, pixels of the window. */
export function pointOf(event: MouseEvent | TouchEvent): { x: number; y: number } | null {
  const pointer = "changedTouches" in event ? event.changedTouches[0] : event;
  return pointer ? { x: pointer.clientX, y: pointer.clientY } : null;
}

function inside(box: Box, { x, y }: PixelPoint): boolean {
  return x > box.left && x < box.right && y > box.top && y < box.bottom;
}
