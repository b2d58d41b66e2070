/** A measurement while it is made, and where its length is written; pure, metres of the map frame. */
import type { PixelPoint } from "@/map/plane/paths";
import type { Box, Point } from "@/map/plane/projection";

export type Line = readonly [Point, Point];

export interface Measuring {
  /** None, one, or both. */
  readonly ends: readonly Point[];
  /** Where the next end would be; null where nobody points. */
  readonly aim: Point | null;
  /** Where the cross-hair of the keys stands; null while somebody points. */
  readonly cross: Point | null;
  /** Where a press began that still lasts, and whether it put the first end. */
  readonly grip: { readonly at: Point; readonly begins: boolean } | null;
}

export const NOTHING: Measuring = { ends: [], aim: null, cross: null, grip: null };

/** One more end: the second after the first, else the first of a new line. */
export function withEnd(measuring: Measuring, end: Point): Measuring {
  const [first, second] = measuring.ends;
  return { ...measuring, ends: first && !second ? [first, end] : [end] };
}

/** A pointer is at `aim`. */
export const aimed = (measuring: Measuring, aim: Point): Measuring => ({ ...measuring, aim, cross: null });

/** The pointer has gone; a cross-hair stays. */
export const left = (measuring: Measuring): Measuring => (measuring.cross ? measuring : { ...measuring, aim: null });

/** A press at `at`, which snaps to `end`: a first end is there at once, a second one where it is let go. */
export function pressed(measuring: Measuring, at: Point, end: Point): Measuring {
  const begins = measuring.ends.length !== 1;
  const aiming = { ...aimed(measuring, end), grip: { at, begins } };
  return begins ? withEnd(aiming, end) : aiming;
}

/** A press is let go at `at`, which snaps to `end`; after a drag of at least `far` metres that is the second end. */
export function released(measuring: Measuring, at: Point, end: Point, far: number): Measuring {
  const { grip } = measuring;
  if (!grip) return measuring;
  const free = { ...measuring, grip: null };
  return grip.begins && lengthOf([grip.at, at]) < far ? free : withEnd(free, end);
}

/** The press came to nothing, as when a finger scrolls. */
export const cancelled = (measuring: Measuring): Measuring =>
  measuring.grip?.begins ? NOTHING : { ...measuring, grip: null, aim: null };

/** The cross-hair is moved on to `cross`, from where `aim` would be the next end. */
export const stepped = (measuring: Measuring, cross: Point, aim: Point): Measuring => ({ ...measuring, cross, aim });

/** Without its line. */
export const cleared = (measuring: Measuring): Measuring => ({ ...measuring, ends: [], grip: null });

/** What is measured so far; null where there is one end at most and nobody points. */
export function lineOf({ ends: [first, second], aim }: Measuring): Line | null {
  const last = second ?? aim;
  return first && last ? [first, last] : null;
}

/** Metres from the first point to the last. */
export function lengthOf(points: readonly Point[]): number {
  const [first, last] = [points[0], points.at(-1)];
  return first && last ? Math.hypot(last[0] - first[0], last[1] - first[1]) : 0;
}

/** The label of a length: half as wide and as high, and how far its middle is from the line; pixels of the screen. */
export const LABEL = { halfWidth: 34, halfHeight: 12, lift: 20, aside: 46 } as const;
/** So far (pixels of the screen) it may stand out over the frame. */
const OVER = 10;

/**
 * Where the middle of the label is, in drawing pixels: above a flat line, beside a steep one, clear of its ends.
 *
 * With a frame it is inside, on the other side of the line where it would be cut off.
 */
export function labelMiddle(a: PixelPoint, b: PixelPoint, zoom: number, frame: Box | null): PixelPoint {
  const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  const { x, y } = labelOffset(Math.abs(b.x - a.x) * zoom, Math.abs(b.y - a.y) * zoom);
  const [dx, dy] = [x / zoom, y / zoom];
  if (!frame) return { x: middle.x + dx, y: middle.y - dy };
  const [wide, high] = [(LABEL.halfWidth - OVER) / zoom, (LABEL.halfHeight - OVER) / zoom];
  const [right, top] = [frame.right - wide, frame.top + high];
  const side = { x: middle.x + (middle.x + dx > right ? -dx : dx), y: middle.y + (middle.y - dy < top ? dy : -dy) };
  return {
    x: Math.max(frame.left + wide, Math.min(right, side.x)),
    y: Math.max(top, Math.min(frame.bottom - high, side.y)),
  };
}

/** How far to the right and up from the middle of a line, so wide and high on the screen, its label is. */
function labelOffset(width: number, height: number): PixelPoint {
  const { halfWidth, halfHeight, lift, aside } = LABEL;
  if (width >= height) return { x: 0, y: lift + (width < 2 * halfWidth ? height / 2 : 0) };
  return { x: aside + (height < 2 * halfHeight ? width / 2 : 0), y: 0 };
}
