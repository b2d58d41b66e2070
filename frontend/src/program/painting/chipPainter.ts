/** Paints a construct as its element looks: badge, icon, words; or as much of it as can be told from afar. */
import type { Palette } from "@/map/plane/palette";
import type { Chip } from "../scene/chips";
import { faceColours, OF_CHANGE, paintFace, paintTag } from "./chipFaces";
import { paintFlag } from "./linePainter";
import { resolved, type Brush, type OtherPerson, type Painted, type StepState } from "./looks";
import { markOf, paintMark } from "./marks";

type Canvas = CanvasRenderingContext2D;

export function paintChip(brush: Brush, chip: Chip): void {
  const { canvas, looks, detail } = brush;
  const state = chip.shape === "note" ? null : looks.stateOf(chip.id);
  const painted = faceColours(brush.palette, chip, state);
  canvas.save();
  canvas.translate(chip.at.x, chip.at.y);
  canvas.globalAlpha = state === "same" ? 0.42 : state === "skipped" ? 0.6 : 1;
  if (detail === "dot") paintDot(brush, painted);
  else if (chip.shape === "diamond") paintDiamond(brush, painted);
  else paintBox(brush, painted);
  canvas.restore();
}

/** Of a chip in small: how wide and high it is painted. */
export function paintedSize(chip: Chip, detail: Brush["detail"]): { width: number; height: number } {
  if (detail === "full" || chip.shape === "diamond") return { width: chip.width, height: chip.height };
  const icon = { width: Math.min(chip.width, chip.number ? 62 : 30), height: 28 };
  return detail === "icon" ? icon : { width: Math.min(chip.width, 62), height: 30 };
}

/** Never smaller on the screen than can be told from the floor, and never so large that neighbours are covered. */
const LEAST_ON_SCREEN = 4.5;

function paintDot(brush: Brush, painted: Painted): void {
  const { canvas, palette, looks, zoom } = brush;
  const { chip, state } = painted;
  const size = paintedSize(chip, "dot");
  const [width, height] = [Math.max(size.width, LEAST_ON_SCREEN / zoom), Math.max(size.height, LEAST_ON_SCREEN / zoom)];
  outline(canvas, chip, width, height);
  canvas.fillStyle = state === "planned" || state === "skipped" || chip.draft ? painted.soft : painted.border;
  canvas.fill();
  canvas.strokeStyle = painted.border;
  canvas.lineWidth = 1.2 / zoom;
  canvas.stroke();
  const mark = markOf(chip.problem, state);
  if (mark) {
    // As large as a mark of the map's, so that its shape is told however far away.
    canvas.save();
    canvas.translate(width / 2, -height / 2);
    canvas.scale(0.62 / zoom, 0.62 / zoom);
    paintMark(canvas, palette, mark);
    canvas.restore();
  }
  paintAround(brush, chip, { width, height }, looks.othersOn.get(chip.id) ?? null, 2 / zoom);
}

function outline(canvas: Canvas, chip: Chip, width: number, height: number): void {
  canvas.beginPath();
  if (chip.shape === "diamond") {
    const half = Math.max(width, height) * 0.6;
    for (const [x, y] of [
      [0, -half],
      [half, 0],
      [0, half],
      [-half, 0],
    ] as const)
      canvas.lineTo(x, y);
    canvas.closePath();
  } else canvas.roundRect(-width / 2, -height / 2, width, height, radiusOf(chip, height));
}

function radiusOf(chip: Chip, height: number): number {
  if (chip.shape === "box") return 7;
  return chip.shape === "fork" ? 8 : Math.min(14, height / 2);
}

function paintBox(brush: Brush, painted: Painted): void {
  const { canvas, palette, detail, looks } = brush;
  const { chip, state } = painted;
  const { width, height } = paintedSize(chip, detail);
  const other = looks.othersOn.get(chip.id) ?? null;
  if (chip.shape === "header") paintGround(brush, painted, width, height);
  else {
    paintBody(brush, painted, width, height);
    paintAround(brush, chip, { width, height }, other, 2);
  }
  paintFace(brush, painted, width, height);
  if (chip.shape === "header") return;
  corner(canvas, width / 2 - 2.6, 1.6 - height / 2, () => paintMark(canvas, palette, markOf(chip.problem, state)));
  if (other) paintFlag(canvas, palette, other, width / 2 + 8, -height / 2);
}

/** A border's width as browsers draw it: whole dots of the screen, rounded down. */
function asStyled(width: number): number {
  const dots = window.devicePixelRatio || 1;
  return Math.max(1, Math.floor(width * dots)) / dots;
}

/** Behind the head of a frame, where the whole frame was added or removed. */
function paintGround({ canvas }: Brush, { state, body }: Painted, width: number, height: number): void {
  if (state !== "added" && state !== "removed") return;
  canvas.beginPath();
  canvas.roundRect(-width / 2, -height / 2, width, height, 14);
  canvas.fillStyle = body;
  canvas.fill();
}

function paintBody({ canvas, detail }: Brush, painted: Painted, width: number, height: number): void {
  const { chip, state } = painted;
  const quiet = state === "planned" || state === "skipped";
  if (state === "running") paintHalo(canvas, painted, { width, height }, { wide: 5, alpha: 0.2 });
  else if (isChange(state) && detail === "full")
    paintHalo(canvas, painted, { width, height }, { wide: 3, alpha: 0.16 });
  else if (detail === "full" && !chip.inner && !quiet && state !== "same")
    paintShadow(canvas, width, height, radiusOf(chip, height));
  const border = asStyled(quiet || chip.shape === "note" ? 1.2 : chip.shape === "root" ? 2 : 1.6);
  canvas.beginPath();
  canvas.roundRect(
    -width / 2 + border / 2,
    -height / 2 + border / 2,
    width - border,
    height - border,
    radiusOf(chip, height) - border / 2,
  );
  canvas.fillStyle = painted.body;
  canvas.fill();
  canvas.strokeStyle = painted.border;
  canvas.lineWidth = border;
  canvas.setLineDash(chip.draft || quiet || state === "removed" ? [4, 3] : []);
  canvas.stroke();
  canvas.setLineDash([]);
  if (chip.shape !== "fork") return;
  canvas.fillStyle = painted.border;
  canvas.fillRect(-width / 2 + 6, height / 2 - 4, width - 12, 3.2);
}

function isChange(state: StepState): boolean {
  return (state ?? "") in OF_CHANGE;
}

/** A glow of its border's colour around what is done now, or differs. */
function paintHalo(
  canvas: Canvas,
  { chip, border }: Painted,
  { width, height }: { width: number; height: number },
  { wide, alpha }: { wide: number; alpha: number },
): void {
  const before = canvas.globalAlpha;
  canvas.globalAlpha = before * alpha;
  canvas.fillStyle = border;
  canvas.beginPath();
  const radius = radiusOf(chip, height) + wide;
  canvas.roundRect(-width / 2 - wide, -height / 2 - wide, width + 2 * wide, height + 2 * wide, radius);
  canvas.fill();
  canvas.globalAlpha = before;
}

/** As deep as the design's smallest shadow, without the cost of a blur. */
function paintShadow(canvas: Canvas, width: number, height: number, radius: number): void {
  canvas.beginPath();
  canvas.roundRect(-width / 2 - 0.5, -height / 2 + 0.8, width + 1, height + 1, radius);
  canvas.fillStyle = "rgba(18, 24, 40, 0.08)";
  canvas.fill();
}

function paintDiamond(brush: Brush, painted: Painted): void {
  const { canvas, palette, detail, looks } = brush;
  const { chip, state } = painted;
  const other = looks.othersOn.get(chip.id) ?? null;
  canvas.save();
  canvas.rotate(Math.PI / 4);
  const still = isChange(state) || state === "running" ? null : state;
  paintBody(
    brush,
    { ...painted, state: state === "removed" ? state : still, chip: { ...chip, shape: "box", inner: true } },
    34,
    34,
  );
  paintAround(brush, { ...chip, shape: "box" }, { width: 34, height: 34 }, other, 2);
  canvas.restore();
  paintTag(brush, painted, detail);
  corner(canvas, 17, -17, () => paintMark(canvas, palette, markOf(chip.problem, state)));
  if (other) paintFlag(canvas, palette, other, 31, -23);
}

/** The outline of what this person or somebody else has selected. */
function paintAround(
  { canvas, palette, looks }: Brush,
  chip: Chip,
  size: { width: number; height: number },
  other: OtherPerson | null,
  line: number,
): void {
  const colour = colourAround(palette, looks.selected.has(chip.id), other);
  if (!colour) return;
  const off = 2.5 + line / 2;
  outline(canvas, chip, size.width + 2 * off, size.height + 2 * off);
  canvas.strokeStyle = colour;
  canvas.lineWidth = line;
  canvas.stroke();
}

function colourAround(palette: Palette, selected: boolean, other: OtherPerson | null): string | null {
  if (selected) return palette.brand;
  return other ? resolved(palette, other.colour) : null;
}

function corner(canvas: Canvas, x: number, y: number, draw: () => void): void {
  canvas.translate(x, y);
  draw();
  canvas.translate(-x, -y);
}
