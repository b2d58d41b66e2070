/** Paints what a chip says: its number, its icon, its words, the condition beside or below it. */
import type { Palette, PaletteName } from "@/map/plane/palette";
import type { PixelPoint } from "@/map/plane/paths";
import type { Chip } from "../scene/chips";
import { FONTS, measureText } from "../scene/textWidths";
import { plainText, type TextPart } from "../words/stepWords";
import { BOX, iconPath } from "./iconPaths";
import type { Brush, Painted, StepState } from "./looks";

type Canvas = CanvasRenderingContext2D;

/** The colours of a chip in its state; those of its family while it has none. */
export function faceColours(palette: Palette, chip: Chip, state: StepState): Painted {
  const own = OF_STATE[state ?? ""] ?? [chip.family, `${chip.family}-soft` as PaletteName];
  const [line, soft] = [palette[own[0]], palette[own[1]]];
  const quiet = chip.inner || state === "planned" || state === "skipped" || state === "done";
  return {
    chip,
    state,
    line: chip.shape === "note" ? palette["note-line"] : line,
    border: palette[borderOf(chip, state, own[0])],
    soft,
    body: palette[bodyOf(chip, state)],
    badge: quiet ? soft : line,
    badgeText: quiet ? line : palette.floor,
  };
}

const OF_STATE: Readonly<Record<string, readonly [PaletteName, PaletteName]>> = {
  running: ["busy", "busy-soft"],
  done: ["done", "done-soft"],
  failed: ["error", "error-soft"],
  removed: ["error", "error-soft"],
};

/** What edges the steps that differ between two documents. */
export const OF_CHANGE: Readonly<Record<string, PaletteName>> = {
  added: "done",
  changed: "brand",
  moved: "machine",
  removed: "error",
};

function borderOf(chip: Chip, state: StepState, family: PaletteName): PaletteName {
  const change = OF_CHANGE[state ?? ""];
  if (change) return change;
  if (chip.shape === "note") return "note-line";
  return state === null && chip.problem === "error" ? "error" : family;
}

function bodyOf(chip: Chip, state: StepState): PaletteName {
  if (chip.shape === "note") return "note-soft";
  if (chip.shape !== "diamond" && state === "added") return "done-soft";
  if (chip.shape !== "diamond" && state === "removed") return "error-soft";
  return chip.shape === "root" ? (`${chip.family}-soft` as PaletteName) : "panel";
}

/** From left to right: badge, icon, words; a header's condition below them. */
export function paintFace(brush: Brush, painted: Painted, width: number, height: number): void {
  const { canvas, palette, detail } = brush;
  const { chip } = painted;
  const header = chip.shape === "header";
  const y = header && chip.condition && detail === "full" ? -height / 2 + 15 : 0;
  let x = -width / 2 + (header ? 3 : 4.6);
  if (detail === "icon") x += Math.max(0, (width - 9.2 - (chip.number ? badgeWidth(chip.number) + 6 : 0) - 15) / 2);
  canvas.textBaseline = "middle";
  if (chip.number) x += paintBadge(brush, painted, x, y) + 6;
  paintIcon(
    canvas,
    chip,
    x,
    y,
    chip.shape === "note" ? palette.note : painted.badge === painted.soft ? painted.badgeText : painted.badge,
  );
  if (detail !== "full") return;
  paintParts(brush, chip.parts, { x: x + 21, y }, painted.state === "removed");
  if (header && chip.condition) paintCondition(brush, chip.condition, { x: -width / 2, y: y + 23 }, painted.state);
}

function paintIcon(canvas: Canvas, chip: Chip, x: number, y: number, colour: string): void {
  canvas.save();
  canvas.translate(x, y - 7.5);
  canvas.scale(15 / 24, 15 / 24);
  canvas.strokeStyle = colour;
  canvas.lineWidth = 2;
  canvas.lineCap = canvas.lineJoin = "round";
  canvas.stroke(iconPath(chip.kind === "pick_and_drop" ? BOX : chip.icon));
  canvas.restore();
}

function badgeWidth(number: string): number {
  return Math.max(20, measureText(number, "badge") + 12);
}

/** Paint the number and return how wide its badge is. */
function paintBadge({ canvas }: Brush, painted: Painted, x: number, y: number): number {
  const { chip } = painted;
  const width = badgeWidth(chip.number);
  const height = chip.inner ? 18 : 20;
  canvas.beginPath();
  canvas.roundRect(x, y - height / 2, width, height, isAngular(chip) ? 5 : height / 2);
  canvas.fillStyle = painted.badge;
  canvas.fill();
  canvas.fillStyle = painted.badgeText;
  canvas.textAlign = "center";
  canvas.textBaseline = "middle";
  canvas.font = FONTS.badge;
  canvas.fillText(chip.number, x + width / 2, y + 0.6);
  canvas.textAlign = "left";
  return width;
}

function isAngular(chip: Chip): boolean {
  return ["box", "fork", "header", "diamond"].includes(chip.shape);
}

/** Paint words in a row from a place on; those that are gone are struck through. */
function paintParts({ canvas, palette }: Brush, parts: readonly TextPart[], from: PixelPoint, gone: boolean): void {
  let { x } = from;
  const { y } = from;
  canvas.textAlign = "left";
  canvas.textBaseline = "middle";
  for (const part of parts) {
    if (part.tone === "missing") x += paintMissing(canvas, palette, x, y);
    else {
      if (part.swatch) x += paintSwatch(canvas, palette, part.swatch, x, y);
      const [font, colour] = TONES[part.tone] ?? ["chip", "text"];
      canvas.font = FONTS[font];
      canvas.fillStyle = palette[colour];
      canvas.fillText(part.text, x, y + 0.6);
      const width = measureText(part.text, font);
      if (gone || part.tone === "old") canvas.fillRect(x, y, width, 1.2);
      x += width;
    }
    x += 4;
  }
}

const TONES: Readonly<Partial<Record<TextPart["tone"], readonly [font: keyof typeof FONTS, colour: PaletteName]>>> = {
  mono: ["mono", "logic"],
  soft: ["soft", "text-2"],
  old: ["soft", "text-3"],
};

function paintMissing(canvas: Canvas, palette: Palette, x: number, y: number): number {
  canvas.fillStyle = palette["error-soft"];
  canvas.beginPath();
  canvas.roundRect(x, y - 9, 16, 18, 4);
  canvas.fill();
  canvas.font = FONTS.strong;
  canvas.fillStyle = palette.error;
  canvas.textAlign = "center";
  canvas.fillText("?", x + 8, y + 0.6);
  canvas.textAlign = "left";
  return 16;
}

function paintSwatch(canvas: Canvas, palette: Palette, colour: string, x: number, y: number): number {
  canvas.fillStyle = colour;
  canvas.beginPath();
  canvas.roundRect(x, y - 5, 10, 10, 3);
  canvas.fill();
  canvas.strokeStyle = palette["text-3"];
  canvas.lineWidth = 1;
  canvas.stroke();
  return 14;
}

/** A condition on its own ground; its left edge stands at the place. */
function paintCondition(brush: Brush, parts: readonly TextPart[], { x, y }: PixelPoint, state: StepState): void {
  const { canvas, palette } = brush;
  const width = measureText(plainText(parts), "mono") + 4 * (parts.length - 1) + 14;
  canvas.fillStyle = palette["logic-soft"];
  canvas.beginPath();
  canvas.roundRect(x, y - 9.5, width, 19, 5);
  canvas.fill();
  canvas.fillStyle = palette.logic;
  let at = x + 7;
  canvas.textAlign = "left";
  canvas.textBaseline = "middle";
  for (const part of parts) {
    if (part.tone === "missing") at += paintMissing(canvas, palette, at, y);
    else {
      canvas.font = FONTS.mono;
      canvas.fillStyle = palette.logic;
      canvas.fillText(part.text, at, y + 0.6);
      const wide = measureText(part.text, "mono");
      if (state === "removed") canvas.fillRect(at, y, wide, 1.2);
      at += wide;
    }
    at += 4;
  }
}

/** The word in a diamond, its number, and its condition at the side where it covers nothing. */
export function paintTag(brush: Brush, painted: Painted, detail: Brush["detail"]): void {
  const { canvas, palette } = brush;
  const { chip } = painted;
  if (detail === "full") {
    canvas.font = FONTS.strong;
    canvas.textAlign = "center";
    canvas.textBaseline = "middle";
    canvas.fillStyle = painted.line;
    canvas.fillText(plainText(chip.parts), 0, 0.6);
    canvas.textAlign = "left";
  }
  if (chip.number) paintBadge(brush, painted, -32, -20);
  if (detail !== "full" || !chip.condition) return;
  const width = chip.tagWidth - 2;
  const left = { right: 31, left: -37 - width, above: -7, below: -width / 2, "below-left": -8 - width }[chip.tagSide];
  const top = { right: 0, left: 0, above: -33.5, below: 37.5, "below-left": 37.5 }[chip.tagSide];
  canvas.strokeStyle = palette.casing;
  paintCondition(brush, chip.condition, { x: left, y: top }, painted.state);
}
