/** A map's cells on a canvas, a pixel for a cell, in fixed colours on whatever theme. */
import type { CellMap } from "@/map/floor/rosFiles";

/** As a canvas keeps them: alpha, blue, green, red. */
const COLOURS: Readonly<Record<number, number>> = { 0: 0xffffffff, 100: 0xff59493f };
const UNKNOWN_COLOUR = 0xffd5cdc8;

export function paintCells(canvas: HTMLCanvasElement, { width, height, cells }: CellMap): void {
  const context = canvas.getContext("2d");
  if (!context) return;
  canvas.width = width;
  canvas.height = height;
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  for (let row = 0; row < height; row += 1)
    for (let column = 0; column < width; column += 1)
      pixels[(height - 1 - row) * width + column] = COLOURS[cells[row * width + column] ?? 255] ?? UNKNOWN_COLOUR;
  context.putImageData(image, 0, 0);
}
