/** Metres of the ROS map frame (y up) to drawing pixels (y down) and back. */

export type Point = readonly [number, number];

/** How much of the drawing plane is seen: a plane point p stands at p * zoom + (x, y) on the screen. */
export interface Viewport {
  readonly x: number;
  readonly y: number;
  readonly zoom: number;
}

export interface Box {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** Drawing pixels per metre at 100 %. */
export const PIXELS_PER_METRE = 46;

export function toPixels(point: Point): { x: number; y: number } {
  return { x: point[0] * PIXELS_PER_METRE, y: -point[1] * PIXELS_PER_METRE };
}

/** Metres, to the centimetre, so that documents stay short. */
export function toMetres(pixel: { x: number; y: number }): Point {
  return [round(pixel.x / PIXELS_PER_METRE), round(-pixel.y / PIXELS_PER_METRE)];
}

function round(value: number): number {
  return Math.round(value * 100) / 100 + 0;
}

/** The smallest box around all of them; null when there is none. */
export function boxAround(points: Iterable<{ x: number; y: number }>): Box | null {
  let box: Box | null = null;
  for (const { x, y } of points)
    box = box
      ? {
          left: Math.min(box.left, x),
          top: Math.min(box.top, y),
          right: Math.max(box.right, x),
          bottom: Math.max(box.bottom, y),
        }
      : { left: x, top: y, right: x, bottom: y };
  return box;
}

export interface Insets {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** The viewport that shows the whole box in the part of a width x height pane that no panel covers. */
export function fitViewport(box: Box, width: number, height: number, insets: Insets, most = 2): Viewport {
  const freeWidth = Math.max(40, width - insets.left - insets.right);
  const freeHeight = Math.max(40, height - insets.top - insets.bottom);
  const boxWidth = Math.max(1, box.right - box.left);
  const boxHeight = Math.max(1, box.bottom - box.top);
  const zoom = Math.min(most, freeWidth / boxWidth, freeHeight / boxHeight);
  return {
    zoom,
    x: insets.left + (freeWidth - boxWidth * zoom) / 2 - box.left * zoom,
    y: insets.top + (freeHeight - boxHeight * zoom) / 2 - box.top * zoom,
  };
}

/** The part of the drawing plane that a pane shows, with so many pixels of the screen around it. */
export function seenBox(view: Viewport, size: { width: number; height: number }, margin = 0): Box {
  return {
    left: (-margin - view.x) / view.zoom,
    top: (-margin - view.y) / view.zoom,
    right: (size.width + margin - view.x) / view.zoom,
    bottom: (size.height + margin - view.y) / view.zoom,
  };
}
