/** How a step fares, told by a mark's shape as well as its colour; drawing pixels about a middle at 0, 0. */
import type { Palette } from "@/map/plane/palette";
import type { Chip } from "../scene/chips";
import type { StepState } from "./looks";

export type Mark = "failed" | "done" | "running" | null;

/** The same marks as those of a chip's corner. */
export function markOf(problem: Chip["problem"], state: StepState): Mark {
  if (state === "failed" || (state === null && problem === "error")) return "failed";
  return state === "done" || state === "running" ? state : null;
}

export function paintMark(canvas: CanvasRenderingContext2D, palette: Palette, mark: Mark): void {
  if (mark === "failed") paintOctagon(canvas, palette);
  if (mark === "done") paintTick(canvas, palette);
  if (mark === "running") paintTurning(canvas, palette);
}

const OCTAGON = [-3.2, -7.8, 3.2, -7.8, 7.8, -3.2, 7.8, 3.2, 3.2, 7.8, -3.2, 7.8, -7.8, 3.2, -7.8, -3.2];

function paintOctagon(canvas: CanvasRenderingContext2D, palette: Palette): void {
  canvas.beginPath();
  for (let index = 0; index < OCTAGON.length; index += 2) canvas.lineTo(OCTAGON[index] ?? 0, OCTAGON[index + 1] ?? 0);
  canvas.closePath();
  edge(canvas, palette.error, palette.panel);
  canvas.fillStyle = palette.panel;
  canvas.fillRect(-0.95, -4.6, 1.9, 6);
  canvas.fillRect(-0.95, 2.8, 1.9, 1.9);
}

function paintTick(canvas: CanvasRenderingContext2D, palette: Palette): void {
  canvas.beginPath();
  canvas.arc(0, 0, 7.4, 0, Math.PI * 2);
  edge(canvas, palette.done, palette.panel);
  canvas.beginPath();
  canvas.moveTo(-3.2, 0.2);
  canvas.lineTo(-0.9, 2.6);
  canvas.lineTo(3.3, -2.4);
  canvas.strokeStyle = palette.panel;
  canvas.lineWidth = 1.8;
  canvas.stroke();
}

/** Three quarters of a ring. */
function paintTurning(canvas: CanvasRenderingContext2D, palette: Palette): void {
  canvas.beginPath();
  canvas.arc(0, 0, 6.5, 0, Math.PI * 2);
  canvas.fillStyle = palette.panel;
  canvas.fill();
  canvas.lineWidth = 3;
  canvas.strokeStyle = palette["busy-soft"];
  canvas.stroke();
  canvas.beginPath();
  canvas.arc(0, 0, 6.5, -Math.PI / 2, Math.PI * 0.8);
  canvas.strokeStyle = palette.busy;
  canvas.stroke();
}

function edge(canvas: CanvasRenderingContext2D, fill: string, stroke: string): void {
  canvas.fillStyle = fill;
  canvas.fill();
  canvas.strokeStyle = stroke;
  canvas.lineWidth = 1.4;
  canvas.stroke();
}
