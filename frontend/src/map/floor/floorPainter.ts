/** Paints the floor: hatching outside, grid, walls, rooms' names, docks and rulers. */
import { cellBoxToPixels, knownBox, mergeCells, type FloorPlan } from "./floor";
import type { Palette } from "../plane/palette";
import { PIXELS_PER_METRE, toPixels, type Box, type Viewport } from "../plane/projection";
import { paintObstacles } from "./obstaclePainter";
import { paintZones, paintZoneTags, type ZoneSign } from "./zonePainter";

/** Paints something on the floor, below walls, zones and names; what is free of it is the third. */
export type Underlay = (canvas: CanvasRenderingContext2D, palette: Palette, floor: Path2D) => void;

export interface FloorShapes {
  readonly plan: FloorPlan;
  readonly free: Path2D;
  readonly walls: Path2D;
  readonly box: Box;
  readonly zones: readonly ZoneSign[];
  /** How often robots drove where; null where nobody asks. */
  readonly under: Underlay | null;
}

export interface FloorDetail {
  readonly rulers: boolean;
  readonly labels: boolean;
  readonly grid: boolean;
}

type Canvas = CanvasRenderingContext2D;

/** Names are never written smaller than can be read. */
const roomLabel = (zoom: number) => `500 ${Math.max(11.5, 9 / zoom)}px 'Inter Variable', Inter, sans-serif`;
const RULER_LABEL = "10.5px 'JetBrains Mono', monospace";

/** Merge the cells into shapes once for each map. */
export function floorShapes(plan: FloorPlan, zones: readonly ZoneSign[], under: Underlay | null = null): FloorShapes {
  return {
    plan,
    free: pathOf(
      plan,
      mergeCells(plan, (cell) => cell !== 255),
    ),
    walls: pathOf(
      plan,
      mergeCells(plan, (cell) => cell === 100),
    ),
    box: knownBox(plan),
    zones,
    under,
  };
}

function pathOf(plan: FloorPlan, boxes: ReturnType<typeof mergeCells>): Path2D {
  const path = new Path2D();
  for (const cells of boxes) {
    const box = cellBoxToPixels(plan, cells);
    path.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  }
  return path;
}

export function paintFloor(
  canvas: Canvas,
  size: { width: number; height: number },
  palette: Palette,
  shapes: FloorShapes | null,
  viewport: Viewport,
  detail: FloorDetail,
): void {
  paintOutside(canvas, size, palette);
  if (!shapes) return;
  canvas.save();
  canvas.translate(viewport.x, viewport.y);
  canvas.scale(viewport.zoom, viewport.zoom);
  paintGround(canvas, palette, shapes, viewport.zoom, detail);
  shapes.under?.(canvas, palette, shapes.free);
  paintZones(canvas, palette, shapes.zones, viewport.zoom);
  paintWalls(canvas, palette, shapes, viewport.zoom);
  paintObstacles(canvas, palette, shapes.plan.obstacles ?? [], viewport.zoom);
  if (detail.labels) paintPlaces(canvas, palette, shapes.plan, viewport.zoom);
  if (detail.labels) paintZoneTags(canvas, palette, shapes.zones, viewport.zoom);
  canvas.restore();
  if (detail.rulers) paintRulers(canvas, palette, shapes.box, viewport);
}

/** Pixels of the screen from one line of the hatching to the next. */
const HATCH = 9;
let hatching: { readonly of: string; readonly pattern: CanvasPattern | null } | null = null;

/** Hatching: what is not known is drawn as such. One piece of it, repeated: lines over the whole pane are slow. */
function paintOutside(canvas: Canvas, size: { width: number; height: number }, palette: Palette): void {
  canvas.fillStyle = palette.void;
  canvas.fillRect(0, 0, size.width, size.height);
  const density = window.devicePixelRatio || 1;
  const wanted = `${palette.grid} ${density}`;
  if (hatching?.of !== wanted) hatching = { of: wanted, pattern: hatchPattern(palette, density) };
  if (!hatching.pattern) return;
  canvas.fillStyle = hatching.pattern;
  canvas.fillRect(0, 0, size.width, size.height);
}

function hatchPattern(palette: Palette, density: number): CanvasPattern | null {
  const piece = document.createElement("canvas");
  piece.width = piece.height = Math.round(HATCH * density);
  const canvas = piece.getContext("2d");
  if (!canvas) return null;
  const scale = piece.width / HATCH;
  canvas.scale(scale, scale);
  canvas.beginPath();
  for (const from of [-HATCH, 0, HATCH]) {
    canvas.moveTo(from - 1, HATCH + 1);
    canvas.lineTo(from + HATCH + 1, -1);
  }
  canvas.strokeStyle = palette.grid;
  canvas.lineWidth = 1;
  canvas.stroke();
  const pattern = canvas.createPattern(piece, "repeat");
  pattern?.setTransform(new DOMMatrix().scale(1 / scale));
  return pattern;
}

function paintGround(canvas: Canvas, palette: Palette, shapes: FloorShapes, zoom: number, detail: FloorDetail): void {
  canvas.fillStyle = palette.floor;
  canvas.fill(shapes.free);
  // A hairline of floor over the seams between boxes, which antialiasing would leave visible.
  canvas.strokeStyle = palette.floor;
  canvas.lineWidth = 0.6 / zoom;
  canvas.stroke(shapes.free);
  if (!detail.grid || zoom < 0.3) return;
  canvas.save();
  canvas.clip(shapes.free);
  paintGridLines(canvas, shapes.box, 1, palette.grid, zoom);
  paintGridLines(canvas, shapes.box, 5, palette["grid-2"], zoom);
  canvas.restore();
}

function paintGridLines(canvas: Canvas, box: Box, everyMetres: number, colour: string, zoom: number): void {
  const step = everyMetres * PIXELS_PER_METRE;
  canvas.beginPath();
  for (let x = Math.ceil(box.left / step) * step; x <= box.right; x += step) {
    canvas.moveTo(x, box.top);
    canvas.lineTo(x, box.bottom);
  }
  for (let y = Math.ceil(box.top / step) * step; y <= box.bottom; y += step) {
    canvas.moveTo(box.left, y);
    canvas.lineTo(box.right, y);
  }
  canvas.strokeStyle = colour;
  canvas.lineWidth = 1 / zoom;
  canvas.stroke();
}

/** The edge first, twice as wide, then the body over its inner half: an outline without inner seams. */
function paintWalls(canvas: Canvas, palette: Palette, shapes: FloorShapes, zoom: number): void {
  canvas.lineJoin = "round";
  canvas.strokeStyle = palette["wall-edge"];
  canvas.lineWidth = 2.2 / Math.max(zoom, 0.5);
  canvas.stroke(shapes.walls);
  canvas.fillStyle = palette.wall;
  canvas.fill(shapes.walls);
  canvas.strokeStyle = palette.wall;
  canvas.lineWidth = 0.5 / zoom;
  canvas.stroke(shapes.walls);
}

function paintPlaces(canvas: Canvas, palette: Palette, plan: FloorPlan, zoom: number): void {
  for (const place of plan.places) {
    const at = toPixels([place.x, place.y]);
    if (place.kind === "dock") paintDock(canvas, palette, at, place.name, zoom);
    if (place.kind === "room") paintText(canvas, palette, place.name, place.label ? toPixels(place.label) : at, zoom);
    if (place.kind === "point") paintPoint(canvas, palette, at, place.name, zoom);
  }
}

function paintText(canvas: Canvas, palette: Palette, text: string, at: { x: number; y: number }, zoom: number): void {
  if (zoom < 0.45) return;
  canvas.font = roomLabel(zoom);
  canvas.textAlign = "left";
  canvas.textBaseline = "alphabetic";
  canvas.strokeStyle = palette.casing;
  canvas.lineWidth = 4 / zoom;
  canvas.strokeText(text, at.x, at.y);
  canvas.fillStyle = palette["text-3"];
  canvas.fillText(text, at.x, at.y);
}

function paintDock(canvas: Canvas, palette: Palette, at: { x: number; y: number }, name: string, zoom: number): void {
  canvas.strokeStyle = palette["wall-soft"];
  canvas.lineWidth = 1.4;
  canvas.setLineDash([5, 4]);
  canvas.beginPath();
  canvas.roundRect(at.x - 20, at.y - 25, 40, 50, 6);
  canvas.stroke();
  canvas.setLineDash([]);
  canvas.fillStyle = palette["wall-soft"];
  canvas.beginPath();
  canvas.roundRect(at.x - 13, at.y - 33, 26, 5, 2.5);
  canvas.fill();
  if (zoom < 0.45) return;
  canvas.font = roomLabel(zoom);
  canvas.textAlign = "center";
  canvas.fillStyle = palette["text-3"];
  canvas.fillText(name, at.x, at.y - 38);
}

function paintPoint(canvas: Canvas, palette: Palette, at: { x: number; y: number }, name: string, zoom: number): void {
  canvas.fillStyle = palette["text-3"];
  canvas.beginPath();
  canvas.arc(at.x, at.y, 3, 0, Math.PI * 2);
  canvas.fill();
  paintText(canvas, palette, name, { x: at.x + 7, y: at.y + 4 }, zoom);
}

/** Numbers every 5 m along the top and the left edge of the floor. */
function paintRulers(canvas: Canvas, palette: Palette, box: Box, viewport: Viewport): void {
  const step = 5 * PIXELS_PER_METRE;
  canvas.font = RULER_LABEL;
  canvas.fillStyle = palette["text-3"];
  canvas.strokeStyle = palette["text-3"];
  canvas.lineWidth = 1;
  const top = box.top * viewport.zoom + viewport.y;
  const left = box.left * viewport.zoom + viewport.x;
  canvas.textAlign = "left";
  for (let x = Math.ceil((box.left - 1) / step) * step; x <= box.right; x += step) {
    const at = x * viewport.zoom + viewport.x;
    tick(canvas, at, top - 4, at, top - 12);
    canvas.fillText(`${Math.round(x / PIXELS_PER_METRE)}${x === 0 ? " m" : ""}`.replace("-", "−"), at + 4, top - 5);
  }
  canvas.textAlign = "right";
  for (let y = Math.ceil((box.top + 1) / step) * step; y <= box.bottom; y += step) {
    const at = y * viewport.zoom + viewport.y;
    if (y === 0) continue;
    tick(canvas, left - 4, at, left - 12, at);
    canvas.fillText(`${Math.round(-y / PIXELS_PER_METRE)}`.replace("-", "−"), left - 14, at + 3.5);
  }
}

function tick(canvas: Canvas, x1: number, y1: number, x2: number, y2: number): void {
  canvas.beginPath();
  canvas.moveTo(x1, y1);
  canvas.lineTo(x2, y2);
  canvas.stroke();
}
