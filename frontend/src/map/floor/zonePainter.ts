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
  readonly filling: "lines" | "arrows" | "dots" | "none";
  /** Drawing pixels from one line, arrow or dot of the filling to the next. */
  readonly gap: number;
  readonly tint: number;
}

type Canvas = CanvasRenderingContext2D;

const LOOKS: Readonly<Record<MapZone["rule"], Look>> = {
  keep_out: { line: "error", dash: [], filling: "lines", gap: 8, tint: 0.08 },
  slow: { line: "warn-fill", dash: [7, 4], filling: "lines", gap: 18, tint: 0.08 },
  one_at_a_time: { line: "brand", dash: [], filling: "none", gap: 0, tint: 0.07 },
  one_way: { line: "motion", dash: [2, 4], filling: "arrows", gap: 44, tint: 0.07 },
  preferred: { line: "done", dash: [12, 4], filling: "dots", gap: 16, tint: 0.07 },
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
    const { line, dash, filling, gap, tint } = LOOKS[zone.rule];
    canvas.save();
    canvas.fillStyle = canvas.strokeStyle = palette[line];
    canvas.globalAlpha = tint;
    canvas.fill(outline);
    canvas.globalAlpha = 0.5;
    canvas.lineWidth = 1.2;
    if (filling !== "none") paintFilling(canvas, outline, linesOf(filling, box, gap, zone.heading_deg ?? 0));
    canvas.globalAlpha = 1;
    canvas.lineWidth = 1.8 / Math.max(zoom, 0.4);
    canvas.lineJoin = "round";
    canvas.setLineDash([...dash]);
    canvas.stroke(outline);
    canvas.restore();
  }
}

function paintFilling(canvas: Canvas, outline: Path2D, lines: Path2D): void {
  canvas.save();
  canvas.clip(outline);
  canvas.lineCap = canvas.lineJoin = "round";
  canvas.stroke(lines);
  canvas.restore();
}

function linesOf(filling: Exclude<Look["filling"], "none">, box: Box, gap: number, heading_deg: number): Path2D {
  const path = new Path2D();
  if (filling === "lines") {
    const height = box.bottom - box.top;
    for (let x = Math.floor((box.left - height) / gap) * gap; x <= box.right; x += gap) {
      path.moveTo(x, box.bottom);
      path.lineTo(x + height, box.top);
    }
    return path;
  }
  const columns = Math.max(1, Math.floor((box.right - box.left) / gap));
  const rows = Math.max(1, Math.floor((box.bottom - box.top) / gap));
  const left = (box.left + box.right - (columns - 1) * gap) / 2;
  const top = (box.top + box.bottom - (rows - 1) * gap) / 2;
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const [x, y] = [left + column * gap, top + row * gap];
      if (filling === "arrows") addArrow(path, x, y, 9, heading_deg);
      else addDot(path, x, y, 1.6);
    }
  }
  return path;
}

function addDot(path: Path2D, x: number, y: number, radius: number): void {
  path.moveTo(x + radius, y);
  path.arc(x, y, radius, 0, 2 * Math.PI);
}

/** An arrow around a point; its head shows the direction, on a screen whose y leads down. */
function addArrow(path: Path2D, x: number, y: number, half: number, heading_deg: number): void {
  const angle = (-heading_deg * Math.PI) / 180;
  const at = (along: number, across: number): [number, number] => [
    x + along * Math.cos(angle) - across * Math.sin(angle),
    y + along * Math.sin(angle) + across * Math.cos(angle),
  ];
  path.moveTo(...at(-half, 0));
  path.lineTo(...at(half, 0));
  path.moveTo(...at(half * 0.35, -half * 0.6));
  path.lineTo(...at(half, 0));
  path.lineTo(...at(half * 0.35, half * 0.6));
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
  canvas.stroke(iconOf(zone, left + TAG.pad + TAG.icon / 2, middle));
  canvas.fillStyle = palette.text;
  canvas.fillText(said, left + TAG.pad + TAG.icon + TAG.gap, middle + 0.5);
}

/** A barred circle, a dial, an arrow, a tick, one head: what each rule says without words. */
function iconOf({ rule, heading_deg }: MapZone, x: number, y: number): Path2D {
  const path = new Path2D();
  if (rule === "keep_out") {
    path.arc(x, y, 5.5, 0, 2 * Math.PI);
    path.moveTo(x - 3.9, y - 3.9);
    path.lineTo(x + 3.9, y + 3.9);
  } else if (rule === "slow") {
    path.arc(x, y + 2, 6, Math.PI, 2 * Math.PI);
    path.moveTo(x, y + 2);
    path.lineTo(x - 3, y - 2);
  } else if (rule === "one_way") {
    addArrow(path, x, y, 6, heading_deg ?? 0);
  } else if (rule === "preferred") {
    path.moveTo(x - 5, y);
    path.lineTo(x - 1.5, y + 4);
    path.lineTo(x + 5.5, y - 4.5);
  } else {
    path.arc(x, y - 3, 2.6, 0, 2 * Math.PI);
    path.moveTo(x - 5, y + 6);
    path.arc(x, y + 6, 5, Math.PI, 2 * Math.PI);
  }
  return path;
}
