/** Paints how often robots drove where: one small picture with a dot for each square of the floor, drawn large. */
import type { Palette } from "@/map/plane/palette";
import { PIXELS_PER_METRE, type Box } from "@/map/plane/projection";

export interface Heat {
  /** The side of a square in metres; the square (0, 0) has its lower left corner in the map's origin. */
  readonly square_m: number;
  /** Column along x, row along y, how many drives came through. */
  readonly squares: readonly (readonly [column: number, row: number, drives: number])[];
}

/** How much of the colour a square has through which one drive of very many came, and one with the most. */
export const FAINTEST = 0.2;
export const STRONGEST = 0.72;

interface Picture {
  readonly colour: string;
  readonly image: HTMLCanvasElement;
}

/** Drawn once for each heat and theme. */
const pictures = new WeakMap<Heat, Picture>();

export function mostDrives({ squares }: Heat): number {
  return squares.reduce((most, [, , drives]) => Math.max(most, drives), 0);
}

/** How much of the colour so many drives have, of the most that any square has. */
export function strengthOf(drives: number, most: number): number {
  return FAINTEST + (STRONGEST - FAINTEST) * (most > 1 ? (drives - 1) / (most - 1) : 1);
}

/** Columns and rows that have any squares, ends included, with one empty one more on each side. */
export function extentOf({ squares }: Heat): { column: number; row: number; columns: number; rows: number } {
  let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const [column, row] of squares) {
    [left, right] = [Math.min(left, column), Math.max(right, column)];
    [bottom, top] = [Math.min(bottom, row), Math.max(top, row)];
  }
  return { column: left - 1, row: bottom - 1, columns: right - left + 3, rows: top - bottom + 3 };
}

/** Where the picture lies, in drawing pixels. */
export function boxOf(heat: Heat): Box {
  const { column, row, columns, rows } = extentOf(heat);
  const side = heat.square_m * PIXELS_PER_METRE;
  return { left: column * side, top: -(row + rows) * side, right: (column + columns) * side, bottom: -row * side };
}

/** Only on the floor: drawn large, a dot reaches half a square beyond its own. */
export function paintHeat(canvas: CanvasRenderingContext2D, palette: Palette, heat: Heat, floor: Path2D): void {
  if (heat.squares.length === 0) return;
  const { left, top, right, bottom } = boxOf(heat);
  canvas.save();
  canvas.clip(floor);
  canvas.imageSmoothingEnabled = true;
  canvas.imageSmoothingQuality = "high";
  canvas.drawImage(pictureOf(heat, palette["warn-fill"]), left, top, right - left, bottom - top);
  canvas.restore();
}

function pictureOf(heat: Heat, colour: string): HTMLCanvasElement {
  const known = pictures.get(heat);
  if (known?.colour === colour) return known.image;
  const image = drawPicture(heat, colour);
  pictures.set(heat, { colour, image });
  return image;
}

/** A dot for each square, the topmost row first. */
function drawPicture(heat: Heat, colour: string): HTMLCanvasElement {
  const { column, row, columns, rows } = extentOf(heat);
  const image = document.createElement("canvas");
  [image.width, image.height] = [columns, rows];
  const canvas = image.getContext("2d");
  if (!canvas) return image;
  const most = mostDrives(heat);
  canvas.fillStyle = colour;
  for (const [x, y, drives] of heat.squares) {
    canvas.globalAlpha = strengthOf(drives, most);
    canvas.fillRect(x - column, rows - 1 - (y - row), 1, 1);
  }
  return image;
}
