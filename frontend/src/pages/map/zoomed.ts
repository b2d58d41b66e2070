/** A map that fits, seen from nearer: zoomed at a point, moved by hand, and never lost from sight; pure. */
import type { Box, Viewport } from "@/map/plane/projection";

/** How near one may come, in pixels of the screen for a drawing pixel. */
export const NEAREST = 8;

export interface Pane {
  readonly width: number;
  readonly height: number;
}

/** The view with `factor` times the zoom; the point (x, y) of the pane stays. Null where the whole fits again. */
export function zoomedAt(view: Viewport, fit: Viewport, factor: number, x: number, y: number): Viewport | null {
  const zoom = Math.min(Math.max(NEAREST, fit.zoom), view.zoom * factor);
  if (zoom <= fit.zoom * 1.001) return null;
  const by = zoom / view.zoom;
  return { zoom, x: x - (x - view.x) * by, y: y - (y - view.y) * by };
}

/** Where something is on the pane, in pixels from its upper left corner. */
export interface Shown extends Pane {
  readonly x: number;
  readonly y: number;
}

/** The view with something in the middle of the pane; the same view where it is seen already. */
export function showing(view: Viewport, { x, y, width, height }: Shown, pane: Pane): Viewport {
  if (isSeen(x, width, pane.width) && isSeen(y, height, pane.height)) return view;
  return { ...view, x: view.x + (pane.width - width) / 2 - x, y: view.y + (pane.height - height) / 2 - y };
}

/** Whether the middle of a length lies in the pane, or any of it where it is longer than the pane. */
function isSeen(from: number, length: number, pane: number): boolean {
  if (length > pane) return from < pane && from + length > 0;
  const middle = from + length / 2;
  return middle >= 0 && middle <= pane;
}

/** The view with the map moved so that its frame covers the middle of the pane. */
export function kept(view: Viewport, frame: Box, { width, height }: Pane): Viewport {
  const between = (value: number, low: number, high: number) => Math.min(high, Math.max(low, value));
  return {
    zoom: view.zoom,
    x: between(view.x, width / 2 - frame.right * view.zoom, width / 2 - frame.left * view.zoom),
    y: between(view.y, height / 2 - frame.bottom * view.zoom, height / 2 - frame.top * view.zoom),
  };
}
