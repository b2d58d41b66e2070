/** Paints the zones of the floor: each rule has its own hatching, border and sign, so that none needs its colour. */
import type { Palette, PaletteName } from "../plane/palette";
import { boxAround, toPixels, type Box } from "../plane/projection";
import type { MapZone } from "./floor";
import { openUntil } from "./openZones";

export interface ZoneSign {
  readonly zone: MapZone;
  readonly look: Look;
  /** Its rule and name, and its rule alone where there is no room for both. */
  readonly words: readonly [string, string];
  readonly outline: Path2D;
  /** What it is filled with: lines, chevrons or dots. */
  readonly filling: Path2D;
  readonly box: Box;
}

interface Spot {
  readonly x: number;
  readonly y: number;
}

interface Look {
  readonly icon: MapZone["rule"] | "open";
  readonly line: PaletteName;
  readonly dash: readonly number[];
  readonly filling: "lines" | "chevrons" | "dots" | "none";
  /** Drawing pixels from one line, chevron or dot of the filling to the next. */
  readonly gap: number;
  /** How thick and how strong the filling is drawn. */
  readonly stroke: number;
  readonly alpha: number;
  readonly tint: number;
}

type Canvas = CanvasRenderingContext2D;

const LOOKS: Readonly<Record<MapZone["rule"], Omit<Look, "icon">>> = {
  keep_out: { line: "error", dash: [], filling: "lines", gap: 8, stroke: 1.2, alpha: 0.5, tint: 0.08 },
  slow: { line: "warn-fill", dash: [7, 4], filling: "lines", gap: 18, stroke: 1.2, alpha: 0.5, tint: 0.08 },
  one_at_a_time: { line: "brand", dash: [], filling: "none", gap: 0, stroke: 0, alpha: 0, tint: 0.07 },
  one_way: { line: "motion", dash: [], filling: "chevrons", gap: 45, stroke: 2.6, alpha: 1, tint: 0.07 },
  release: { line: "error", dash: [3, 4], filling: "lines", gap: 26, stroke: 1.2, alpha: 0.5, tint: 0.06 },
  preferred: { line: "done", dash: [12, 4], filling: "dots", gap: 16, stroke: 1.2, alpha: 0.5, tint: 0.07 },
};
/** Of a zone that is open to all robots for a time. */
const OPEN: Look = { ...LOOKS.release, icon: "open", line: "done", filling: "none" };
const FONT = "600 11.5px 'Inter Variable', Inter, sans-serif";
/** So many chevrons or dots are drawn in a zone at most. */
const MOST_SPOTS = 400;
/** Below this zoom words could not be read; the hatching stays. */
const WORDS_FROM = 0.45;
const TAG = { height: 22, pad: 7, icon: 14, gap: 5, inset: 5 };

/** How a zone is shown at a time, milliseconds. */
export function zoneSign(zone: MapZone, words: ZoneSign["words"], at: number): ZoneSign {
  const corners = zone.points.map(toPixels);
  const outline = new Path2D();
  corners.forEach(({ x, y }, index) => (index === 0 ? outline.moveTo(x, y) : outline.lineTo(x, y)));
  outline.closePath();
  const box = boxAround(corners) ?? { left: 0, top: 0, right: 0, bottom: 0 };
  const look: Look = openUntil(zone, at) ? OPEN : { ...LOOKS[zone.rule], icon: zone.rule };
  return { zone, look, words, outline, filling: fillingOf(zone, look, box), box };
}

export function paintZones(canvas: Canvas, palette: Palette, signs: readonly ZoneSign[], zoom: number): void {
  for (const { look, outline, filling } of signs) {
    const { line, dash, stroke, alpha, tint } = look;
    canvas.save();
    canvas.fillStyle = canvas.strokeStyle = palette[line];
    canvas.globalAlpha = tint;
    canvas.fill(outline);
    canvas.save();
    canvas.clip(outline);
    canvas.globalAlpha = alpha;
    canvas.lineWidth = stroke;
    canvas.stroke(filling);
    canvas.restore();
    canvas.globalAlpha = 1;
    canvas.lineWidth = 1.8 / Math.max(zoom, 0.4);
    canvas.lineJoin = "round";
    canvas.setLineDash([...dash]);
    canvas.stroke(outline);
    canvas.restore();
  }
}

function fillingOf({ heading_deg }: MapZone, { filling, gap }: Look, box: Box): Path2D {
  const path = new Path2D();
  if (filling === "lines") addLines(path, box, gap);
  else if (filling === "chevrons") for (const at of spread(box, gap)) addChevron(path, at, 7, heading_deg ?? 0);
  else if (filling === "dots") for (const at of spread(box, gap)) addDot(path, at, 1.6);
  return path;
}

function addLines(path: Path2D, box: Box, gap: number): void {
  const height = box.bottom - box.top;
  for (let x = Math.floor((box.left - height) / gap) * gap; x <= box.right; x += gap) {
    path.moveTo(x, box.bottom);
    path.lineTo(x + height, box.top);
  }
}

/** Points over a box in rows and columns; farther apart in a large one, so that there are not too many. */
function spread(box: Box, gap: number): Spot[] {
  const [width, height] = [box.right - box.left, box.bottom - box.top];
  const wide = Math.max(gap, Math.sqrt((width * height) / MOST_SPOTS));
  const columns = Math.max(1, Math.floor(width / wide));
  const rows = Math.max(1, Math.floor(height / wide));
  const left = (box.left + box.right - (columns - 1) * wide) / 2;
  const top = (box.top + box.bottom - (rows - 1) * wide) / 2;
  return Array.from({ length: rows * columns }, (_, index) => ({
    x: left + (index % columns) * wide,
    y: top + Math.floor(index / columns) * wide,
  }));
}

function addDot(path: Path2D, { x, y }: Spot, radius: number): void {
  path.moveTo(x + radius, y);
  path.arc(x, y, radius, 0, 2 * Math.PI);
}

/** Turns what leads to the right into a direction, on a screen whose y leads down. */
function turned({ x, y }: Spot, heading_deg: number): (along: number, across: number) => [number, number] {
  const angle = (-heading_deg * Math.PI) / 180;
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  return (along, across) => [x + along * cos - across * sin, y + along * sin + across * cos];
}

function addChevron(path: Path2D, spot: Spot, half: number, heading_deg: number): void {
  const at = turned(spot, heading_deg);
  path.moveTo(...at(-half / 2, -half));
  path.lineTo(...at(half / 2, 0));
  path.lineTo(...at(-half / 2, half));
}

function addArrow(path: Path2D, spot: Spot, half: number, heading_deg: number): void {
  const at = turned(spot, heading_deg);
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

function paintTag(canvas: Canvas, palette: Palette, { zone, look, words, box }: ZoneSign): void {
  const room = box.right - box.left - 2 * TAG.inset;
  const widthOf = (text: string) => 2 * TAG.pad + TAG.icon + TAG.gap + canvas.measureText(text).width;
  const said = widthOf(words[0]) <= room ? words[0] : words[1];
  const width = widthOf(said);
  const left = width <= room ? box.left + TAG.inset : (box.left + box.right - width) / 2;
  const top = Math.max(box.top + TAG.inset, box.bottom - TAG.height - TAG.inset);
  const line = palette[look.line];
  canvas.fillStyle = palette.panel;
  canvas.strokeStyle = line;
  canvas.lineWidth = 1.2;
  canvas.beginPath();
  canvas.roundRect(left, top, width, TAG.height, 6);
  canvas.fill();
  canvas.stroke();
  const middle = top + TAG.height / 2;
  canvas.lineWidth = 1.5;
  canvas.stroke(iconOf(look.icon, zone.heading_deg, left + TAG.pad + TAG.icon / 2, middle));
  canvas.fillStyle = palette.text;
  canvas.fillText(said, left + TAG.pad + TAG.icon + TAG.gap, middle + 0.5);
}

/** A barred circle, a lock, an open one, a dial, an arrow, a tick, one head: what each rule says without words. */
function iconOf(rule: Look["icon"], heading_deg: number | null, x: number, y: number): Path2D {
  const path = new Path2D();
  if (rule === "keep_out") {
    path.arc(x, y, 5.5, 0, 2 * Math.PI);
    path.moveTo(x - 3.9, y - 3.9);
    path.lineTo(x + 3.9, y + 3.9);
  } else if (rule === "release" || rule === "open") {
    path.rect(x - 4, y - 1, 8, 6.5);
    path.moveTo(x - 2.6, y - 1);
    path.arc(x, y - (rule === "open" ? 4 : 2.4), 2.6, Math.PI, 2 * Math.PI);
    if (rule === "release") path.lineTo(x + 2.6, y - 1);
  } else if (rule === "slow") {
    path.arc(x, y + 2, 6, Math.PI, 2 * Math.PI);
    path.moveTo(x, y + 2);
    path.lineTo(x - 3, y - 2);
  } else if (rule === "one_way") {
    addArrow(path, { x, y }, 6, heading_deg ?? 0);
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
