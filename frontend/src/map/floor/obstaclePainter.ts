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
  canvas.save();
  canvas.strokeStyle = palette.warn;
  canvas.lineWidth = 1.8 / Math.max(zoom, 0.4);
  canvas.fillStyle = palette["warn-fill"];
  for (const { x, y, size_m } of obstacles) {
    const at = toPixels([x, y]);
    const radius = Math.max((size_m / 2) * PIXELS_PER_METRE, SMALLEST_PX / zoom);
    const arm = radius * Math.SQRT1_2;
    canvas.beginPath();
    canvas.arc(at.x, at.y, radius, 0, 2 * Math.PI);
    canvas.globalAlpha = 0.35;
    canvas.fill();
    canvas.globalAlpha = 1;
    canvas.moveTo(at.x - arm, at.y - arm);
    canvas.lineTo(at.x + arm, at.y + arm);
    canvas.moveTo(at.x - arm, at.y + arm);
    canvas.lineTo(at.x + arm, at.y - arm);
    canvas.stroke();
  }
  canvas.restore();
}
