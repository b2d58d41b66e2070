/** Paints what lies in the way of simulated robots: crossed out, so that it is told from all else without its colour. */
import type { Palette } from "../plane/palette";
import { PIXELS_PER_METRE, toPixels } from "../plane/projection";
import type { MapObstacle } from "./floor";

/** Pixels of the screen: it is seen on a small map, too. */
const SMALLEST_PX = 5;

export function paintObstacles(
  canvas: CanvasRenderingContext2D,
  palette: Palette,
  obstacles: readonly MapObstacle[],
  zoom: number,
): void {
  for (const { x, y, size_m } of obstacles) {
    const at = toPixels([x, y]);
    const radius = Math.max((size_m / 2) * PIXELS_PER_METRE, SMALLEST_PX / zoom);
    const shape = new Path2D();
    shape.arc(at.x, at.y, radius, 0, 2 * Math.PI);
    canvas.fillStyle = palette["warn-fill"];
    canvas.globalAlpha = 0.35;
    canvas.fill(shape);
    canvas.globalAlpha = 1;
    for (const angle of [45, 135, 225, 315]) {
      const turn = (angle * Math.PI) / 180;
      shape.moveTo(at.x, at.y);
      shape.lineTo(at.x + radius * Math.cos(turn), at.y + radius * Math.sin(turn));
    }
    canvas.strokeStyle = palette.warn;
    canvas.lineWidth = 1.8 / Math.max(zoom, 0.4);
    canvas.stroke(shape);
  }
}
