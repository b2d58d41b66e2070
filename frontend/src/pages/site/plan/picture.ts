/** A map out of a picture of a plan: dark is wall, and a line of known length says how large it is. Pure. */
import type { CellMap } from "@/map/floor/rosFiles";

/** Lightness and opacity of each pixel, 0 to 255, top row first. */
export interface Picture {
  readonly width: number;
  readonly height: number;
  readonly light: Uint8Array;
  readonly opaque: Uint8Array;
}

/** A point of the picture: pixels from its left and top. */
export type Pixel = readonly [number, number];

export interface PlanReading {
  /** What is darker is wall: 1 to 255. */
  readonly threshold: number;
  readonly line: readonly [Pixel, Pixel];
  /** How long the line is, metres. */
  readonly length: number;
  /** Whether what can be reached from the picture's edge is unknown instead of floor. */
  readonly outsideUnknown: boolean;
}

export const [FREE, WALL, UNKNOWN] = [0, 100, 255];
/** Metres: pixels are put together to cells of about this size. */
const USUAL_CELL = 0.05;
const [LEAST_CELL, MOST_CELL] = [0.001, 10];
/** Square metres of a map, as MOST_IN_ALL_M2 of the server, which also looks at how much of it is floor. */
const MOST_AREA = 2_000_000;

/** Metres that a pixel is wide; null while the line or its length says nothing. */
export function pixelSize({ line: [from, to], length }: Pick<PlanReading, "line" | "length">): number | null {
  const pixels = Math.hypot(to[0] - from[0], to[1] - from[1]);
  const size = length / pixels;
  return pixels >= 2 && length > 0 && size >= LEAST_CELL && size <= MOST_CELL ? size : null;
}

/** Whether nothing can be planned on a map of so many metres: a length was meant in another unit. */
export function isTooLarge({ width, height }: { readonly width: number; readonly height: number }): boolean {
  return width * height > MOST_AREA;
}

/** How large the map of a picture would be, in metres; null while the line says nothing. */
export function planSize({ width, height }: Picture, reading: PlanReading): { width: number; height: number } | null {
  const size = pixelSize(reading);
  return size === null ? null : { width: width * size, height: height * size };
}

/** Light and opacity out of a canvas's pixels. */
export function pictureOf({
  width,
  height,
  data,
}: {
  width: number;
  height: number;
  data: ArrayLike<number>;
}): Picture {
  const [light, opaque] = [new Uint8Array(width * height), new Uint8Array(width * height)];
  for (let at = 0; at < light.length; at += 1) {
    const [red = 0, green = 0, blue = 0, alpha = 0] = [0, 1, 2, 3].map((part) => data[at * 4 + part]);
    light[at] = Math.round((red + green + blue) / 3);
    opaque[at] = alpha;
  }
  return { width, height, light, opaque };
}

/** The map's cells, bottom row first; a cell is wall as soon as one of its pixels is, so that thin lines stay. */
export function mapFromPicture(picture: Picture, reading: PlanReading): CellMap | null {
  const [size, whole] = [pixelSize(reading), planSize(picture, reading)];
  if (size === null || whole === null || isTooLarge(whole)) return null;
  const step = Math.max(1, Math.round(USUAL_CELL / size));
  const [width, height] = [Math.ceil(picture.width / step), Math.ceil(picture.height / step)];
  const cells = new Uint8Array(width * height).fill(UNKNOWN);
  for (let y = 0; y < picture.height; y += 1) {
    const row = height - 1 - Math.floor(y / step);
    for (let x = 0; x < picture.width; x += 1) {
      const [pixel, cell] = [y * picture.width + x, row * width + Math.floor(x / step)];
      if ((picture.opaque[pixel] ?? 0) < 128) continue;
      if ((picture.light[pixel] ?? 0) < reading.threshold) cells[cell] = WALL;
      else if (cells[cell] === UNKNOWN) cells[cell] = FREE;
    }
  }
  if (reading.outsideUnknown) floodFromEdge(cells, width, height);
  return { width, height, resolution_m: round(size * step), origin: { x: 0, y: 0 }, cells };
}

/** Tenths of a millimetre of a cell are beyond what anybody measures on a plan. */
function round(metres: number): number {
  return Math.round(metres * 1e6) / 1e6;
}

/** Make unknown what is floor and joined to the edge. */
export function floodFromEdge(cells: Uint8Array, width: number, height: number): void {
  const waiting: number[] = [];
  const visit = (at: number) => {
    if (cells[at] !== FREE) return;
    cells[at] = UNKNOWN;
    waiting.push(at);
  };
  for (let column = 0; column < width; column += 1) [column, (height - 1) * width + column].forEach(visit);
  for (let row = 0; row < height; row += 1) [row * width, row * width + width - 1].forEach(visit);
  for (let at = waiting.pop(); at !== undefined; at = waiting.pop()) {
    const column = at % width;
    if (column > 0) visit(at - 1);
    if (column < width - 1) visit(at + 1);
    visit(at - width);
    visit(at + width);
  }
}
