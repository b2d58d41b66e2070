/** Paints the zones of the floor: each rule has its own hatching, border and sign, so that none needs its colour. */
import type { Palette, PaletteName } from "../plane/palette";
import { boxAround, toPixels, type Box } from "../plane/projection";
import type { MapZone } from "./floor";

export interface ZoneSign {
  readonly zone: MapZone;
  /** Its rule and name, and its rule alone where there is no room for both. */
  readonly words: readonly [string, string];
  readonly outline: Path2D;
  readonly box: Box;
}

interface Look {
  readonly line: PaletteName;
  readonly dash: readonly number[];
  /** Drawing pixels from one line of the hatching to the next; 0: none. */
  readonly hatch: number;
  readonly tint: number;
}

type Canvas = CanvasRenderingContext2D;

const LOOKS: Readonly<Record<MapZone["rule"], Look>> = {
  keep_out: { line: "error", dash: [], hatch: 8, tint: 0.08 },
  slow: { line: "warn-fill", dash: [7, 4], hatch: 18, tint: 0.08 },
  one_at_a_time: { line: "brand", dash: [], hatch: 0, tint: 0.07 },
};
const FONT = "600 11.5px 'Inter Variable', Inter, sans-serif";
/** Below this zoom words could not be read; the hatching stays. */
const WORDS_FROM = 0.45;
const TAG = { height: 22, pad: 7, icon: 14, gap: 5, inset: 5 };

export function zoneSign(zone: MapZone, words: ZoneSign["words"]): ZoneSign {
  const corners = zone.points.map(toPixels);
  const outline = new Path2D();
  corners.forEach(({ x, y }, index) => (index === 0 ? outline.moveTo(x, y) : outline.lineTo(x, y)));
  outline.closePath();
  return { zone, words, outline, box: boxAround(corners) ?? { left: 0, top: 0, right: 0, bottom: 0 } };
}

export function paintZones(canvas: Canvas, palette: Palette, signs: readonly ZoneSign[], zoom: number): void {
  for (const { zone, outline, box } of signs) {
    const { line, dash, hatch, tint } = LOOKS[zone.rule];
    canvas.save();
    canvas.fillStyle = canvas.strokeStyle = palette[line];
    canvas.globalAlpha = tint;
    canvas.fill(outline);
    canvas.globalAlpha = 0.5;
    canvas.lineWidth = 1.2;
    if (hatch > 0) paintHatching(canvas, outline, box, hatch);
    canvas.globalAlpha = 1;
    canvas.lineWidth = 1.8 / Math.max(zoom, 0.4);
    canvas.lineJoin = "round";
    canvas.setLineDash([...dash]);
    canvas.stroke(outline);
    canvas.restore();
  }
}

function paintHatching(canvas: Canvas, outline: Path2D, box: Box, gap: number): void {
  canvas.save();
  canvas.clip(outline);
  canvas.beginPath();
  const height = box.bottom - box.top;
  for (let x = Math.floor((box.left - height) / gap) * gap; x <= box.right; x += gap) {
    canvas.moveTo(x, box.bottom);
    canvas.lineTo(x + height, box.top);
  }
  canvas.stroke();
  canvas.restore();
}

/** Signs and words, over all that else stands on the floor. */
export function paintZoneTags(canvas: Canvas, palette: Palette, signs: readonly ZoneSign[], zoom: number): void {
  if (zoom < WORDS_FROM) return;
  canvas.save();
  canvas.font = FONT;
  canvas.textAlign = "left";
  canvas.textBaseline = "middle";
  for (const sign of signs) paintTag(canvas, palette, sign);
  canvas.restore();
}

function paintTag(canvas: Canvas, palette: Palette, { zone, words, box }: ZoneSign): void {
  const room = box.right - box.left - 2 * TAG.inset;
  const widthOf = (text: string) => 2 * TAG.pad + TAG.icon + TAG.gap + canvas.measureText(text).width;
  const said = widthOf(words[0]) <= room ? words[0] : words[1];
  const width = widthOf(said);
  const left = width <= room ? box.left + TAG.inset : (box.left + box.right - width) / 2;
  const top = Math.max(box.top + TAG.inset, box.bottom - TAG.height - TAG.inset);
  const line = palette[LOOKS[zone.rule].line];
  canvas.fillStyle = palette.panel;
  canvas.strokeStyle = line;
  canvas.lineWidth = 1.2;
  canvas.beginPath();
  canvas.roundRect(left, top, width, TAG.height, 6);
  canvas.fill();
  canvas.stroke();
  const middle = top + TAG.height / 2;
  canvas.lineWidth = 1.5;
  canvas.stroke(iconOf(zone.rule, left + TAG.pad + TAG.icon / 2, middle));
  canvas.fillStyle = palette.text;
  canvas.fillText(said, left + TAG.pad + TAG.icon + TAG.gap, middle + 0.5);
}

/** A barred circle, a dial, one head: what each rule says without words. */
function iconOf(rule: MapZone["rule"], x: number, y: number): Path2D {
  const path = new Path2D();
  if (rule === "keep_out") {
    path.arc(x, y, 5.5, 0, 2 * Math.PI);
    path.moveTo(x - 3.9, y - 3.9);
    path.lineTo(x + 3.9, y + 3.9);
  } else if (rule === "slow") {
    path.arc(x, y + 2, 6, Math.PI, 2 * Math.PI);
    path.moveTo(x, y + 2);
    path.lineTo(x - 3, y - 2);
  } else {
    path.arc(x, y - 3, 2.6, 0, 2 * Math.PI);
    path.moveTo(x - 5, y + 6);
    path.arc(x, y + 6, 5, Math.PI, 2 * Math.PI);
  }
  return path;
}
