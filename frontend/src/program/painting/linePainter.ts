/** Paints what is a line: hulls, ways, frames, arrows with their words. The same strokes as their elements have. */
import { angleOf, chevrons, roundedOutline, roundedPath, towards, type PixelPoint } from "@/map/plane/paths";
import type { Box } from "@/map/plane/projection";
import { isLoop } from "../kinds";
import type { Chip } from "../scene/chips";
import type { Frame } from "../scene/frames";
import type { Hull } from "../scene/hulls";
import { type Link, wordPlace } from "../scene/links";
import type { LinePiece, SharedRoute } from "../scene/pieces";
import { OF_CHANGE } from "./chipFaces";
import { furthest, resolved, type Brush, type StepState } from "./looks";
import { markOf, paintMark } from "./marks";

const HEAD = 11;
const WORD = "600 11.5px 'Inter Variable', Inter, sans-serif";
const TARGET_WORD = "500 11.5px 'Inter Variable', Inter, sans-serif";
const INITIALS = "700 10.5px 'Inter Variable', Inter, sans-serif";

export function paintLine(brush: Brush, piece: LinePiece): void {
  if ("hull" in piece) paintHull(brush, piece.hull);
  else if ("route" in piece) paintRoute(brush, piece.route);
  else if ("frame" in piece) paintFrame(brush, piece.frame, piece.problem);
  else paintLink(brush, piece.link);
}

function paintHull({ canvas, palette, zoom }: Brush, hull: Hull): void {
  for (const outline of hull.outlines) {
    const path = new Path2D(roundedOutline(outline));
    canvas.fillStyle = palette["func-soft"];
    canvas.globalAlpha = 0.34;
    canvas.fill(path);
    canvas.globalAlpha = 1;
    canvas.strokeStyle = palette.func;
    canvas.lineWidth = Math.max(1.5, 0.8 / zoom);
    canvas.setLineDash([6, 4]);
    canvas.stroke(path);
    canvas.setLineDash([]);
  }
}

function paintRoute(brush: Brush, route: SharedRoute): void {
  const { canvas, palette, detail, looks } = brush;
  const shown = furthest(route, looks.stateOf);
  const [end, before, start] = [route.points.at(-1), route.points.at(-2), route.points[0]];
  // A line that may cross a wall is never shown: a way appears when the server has found it.
  if (!shown || shown.guessed || !end || !before || !start) return;
  const state = looks.stateOf(shown.step);
  const colour = resolved(palette, ROUTE_COLOURS[state ?? ""] ?? "var(--motion)");
  const line = new Path2D(roundedPath([...route.points.slice(0, -1), towards(end, before, HEAD - 2)]));
  canvas.save();
  canvas.globalAlpha = ROUTE_ALPHAS[state ?? ""] ?? 1;
  const wide = state === "running" || route.steps.some(({ step }) => looks.selected.has(step));
  if (wide) strokeFaintly(canvas, line, colour);
  canvas.strokeStyle = palette.casing;
  canvas.lineWidth = 7.5;
  if (detail !== "dot") canvas.stroke(line);
  canvas.strokeStyle = colour;
  canvas.lineWidth = 3;
  canvas.setLineDash(state === "planned" || state === "running" ? [7, 6] : []);
  canvas.stroke(line);
  canvas.setLineDash([]);
  if (detail !== "dot") for (const at of chevrons(route.points)) paintChevron(canvas, at, at.angle);
  paintHead(canvas, colour, end, angleOf(before, end));
  paintDot(canvas, start, 4.6, palette.floor, 2.2);
  canvas.restore();
}

const ROUTE_COLOURS: Readonly<Record<string, string>> = {
  done: "var(--done)",
  running: "var(--busy)",
  failed: "var(--error)",
};

const ROUTE_ALPHAS: Readonly<Record<string, number>> = { planned: 0.45, skipped: 0.45, done: 0.65, same: 0.3 };

function strokeFaintly(canvas: CanvasRenderingContext2D, line: Path2D, colour: string): void {
  const alpha = canvas.globalAlpha;
  canvas.globalAlpha = alpha * 0.16;
  canvas.strokeStyle = colour;
  canvas.lineWidth = 13;
  canvas.stroke(line);
  canvas.globalAlpha = alpha;
}

function turned(canvas: CanvasRenderingContext2D, { x, y }: PixelPoint, degrees: number, draw: () => void): void {
  canvas.translate(x, y);
  canvas.rotate((degrees * Math.PI) / 180);
  draw();
  canvas.rotate((-degrees * Math.PI) / 180);
  canvas.translate(-x, -y);
}

function paintChevron(canvas: CanvasRenderingContext2D, at: PixelPoint, angle: number): void {
  canvas.lineWidth = 2.2;
  turned(canvas, at, angle, () => strokeThrough(canvas, [-3.5, -5, 1.5, 0, -3.5, 5]));
}

function paintHead(canvas: CanvasRenderingContext2D, colour: string, at: PixelPoint, angle: number): void {
  canvas.fillStyle = colour;
  canvas.lineWidth = 1;
  turned(canvas, at, angle, () => {
    strokeThrough(canvas, [0, 0, -14, -7.5, -11, 0, -14, 7.5, 0, 0]);
    canvas.fill();
  });
}

function paintDot(canvas: CanvasRenderingContext2D, at: PixelPoint, radius: number, fill: string, width: number): void {
  canvas.beginPath();
  canvas.arc(at.x, at.y, radius, 0, Math.PI * 2);
  canvas.fillStyle = fill;
  canvas.fill();
  canvas.lineWidth = width;
  canvas.stroke();
}

function strokeThrough(canvas: CanvasRenderingContext2D, points: readonly number[]): void {
  canvas.beginPath();
  for (let index = 0; index < points.length; index += 2) canvas.lineTo(points[index] ?? 0, points[index + 1] ?? 0);
  canvas.stroke();
}

function paintLink(brush: Brush, link: Link): void {
  const { canvas, palette, detail, looks } = brush;
  const [end, before] = [link.points.at(-1), link.points.at(-2)];
  if (!end || !before) return;
  const near = [link.from, link.to].some((step) => step !== null && looks.selected.has(step));
  const faint =
    (link.tone === "then" && !near) || (link.to !== null && ["planned", "same"].includes(looks.stateOf(link.to) ?? ""));
  const chosen = looks.chosenLink === link.id;
  canvas.save();
  canvas.globalAlpha = faint ? 0.34 : 1;
  canvas.strokeStyle = { then: palette["text-3"], catch: palette.error, branch: palette.logic }[link.tone];
  canvas.lineWidth = chosen ? 2.6 : link.tone === "then" ? 1.3 : 1.6;
  canvas.setLineDash(detail === "dot" ? [] : [2, 4]);
  canvas.stroke(new Path2D(roundedPath([...link.points.slice(0, -1), towards(end, before, 5)], 10)));
  canvas.setLineDash([]);
  if (detail !== "dot") {
    canvas.lineWidth = 1.8;
    turned(canvas, end, angleOf(before, end), () => strokeThrough(canvas, [-6, -4.5, 0, 0, -6, 4.5]));
  }
  if (link.to === null) paintDot(canvas, end, 5, chosen ? String(canvas.strokeStyle) : palette.floor, 1.6);
  if (link.word && detail === "full") paintWord(brush, link, link.word);
  canvas.restore();
}

function paintWord({ canvas, palette }: Brush, link: Link, word: string): void {
  const at = wordPlace(link);
  if (!at) return;
  const colour = canvas.strokeStyle;
  canvas.font = WORD;
  canvas.textBaseline = "alphabetic";
  canvas.textAlign = at.anchor === "middle" ? "center" : "left";
  canvas.strokeStyle = palette.casing;
  canvas.lineWidth = 5;
  canvas.strokeText(word, at.x, at.y);
  canvas.fillStyle = colour;
  canvas.fillText(word, at.x, at.y);
}

/** How far the outline of a selected frame stands off. */
const GAP = 4;

function paintFrame(brush: Brush, frame: Frame, found: Chip["problem"]): void {
  const { canvas, palette, looks } = brush;
  const { box, kind } = frame;
  const state = looks.stateOf(frame.id);
  const problem = state === null ? found : null;
  const other = looks.othersOn.get(frame.id) ?? null;
  const selected = looks.selected.has(frame.id);
  const radius = kind === "try" ? 20 : 12;
  const [line, soft] = frameColours(brush, state, problem === "error");
  const whole = state === "same" ? 0.42 : 1;
  canvas.save();
  canvas.beginPath();
  canvas.roundRect(box.left, box.top, box.right - box.left, box.bottom - box.top, radius);
  canvas.fillStyle = soft;
  canvas.globalAlpha = whole * (state === "planned" || state === "done" ? 0.29 : 0.72);
  canvas.fill();
  canvas.globalAlpha = whole;
  canvas.strokeStyle = line;
  canvas.lineWidth = state === "planned" ? 1.2 : 1.6;
  canvas.setLineDash(state === "planned" ? [4, 3] : []);
  canvas.stroke();
  canvas.setLineDash([]);
  if (isLoop(kind)) paintLoopArrow(canvas, box);
  const around = selected ? palette.brand : (other && resolved(palette, other.colour)) || null;
  if (around) paintAround(canvas, box, radius, around);
  turned(canvas, { x: box.right - 3, y: box.top + 3 }, 0, () => paintMark(canvas, palette, markOf(problem, state)));
  if (other) paintFlag(canvas, palette, other, box.right + GAP, box.top - GAP);
  if (selected && frame.empty && looks.targetWords)
    paintTarget(brush, looks.targetWords({ parent: frame.id, branch: "body" }), box);
  canvas.restore();
}

function frameColours({ palette }: Brush, state: StepState, wrong: boolean): [line: string, soft: string] {
  if (wrong) return [palette.error, palette["error-soft"]];
  if (state === "running") return [palette.busy, palette["busy-soft"]];
  if (state === "done") return [palette.done, palette["logic-soft"]];
  const change = state === "removed" ? undefined : OF_CHANGE[state ?? ""];
  return [state === "failed" ? palette.error : palette[change ?? "logic"], palette["logic-soft"]];
}

/** The border that goes back: what stands inside is done again. */
function paintLoopArrow(canvas: CanvasRenderingContext2D, box: Box): void {
  canvas.lineWidth = 2.4;
  turned(canvas, { x: box.right - 30, y: box.bottom }, 0, () => strokeThrough(canvas, [5, -5.5, -1, 0, 5, 5.5]));
}

function paintAround(canvas: CanvasRenderingContext2D, box: Box, radius: number, colour: string): void {
  canvas.beginPath();
  const [width, height] = [box.right - box.left + 2 * GAP, box.bottom - box.top + 2 * GAP];
  canvas.roundRect(box.left - GAP, box.top - GAP, width, height, radius + GAP);
  canvas.strokeStyle = colour;
  canvas.lineWidth = 2;
  canvas.stroke();
}

/** Somebody's initials; the flag's lower right corner stands at x, y. */
export function paintFlag(
  canvas: CanvasRenderingContext2D,
  palette: Brush["palette"],
  other: { readonly initials: string; readonly colour: string },
  x: number,
  y: number,
): void {
  const width = other.initials.length * 8 + 10;
  canvas.fillStyle = resolved(palette, other.colour);
  canvas.beginPath();
  canvas.roundRect(x - width, y - 17, width, 16, 4);
  canvas.fill();
  canvas.font = INITIALS;
  canvas.textAlign = "center";
  canvas.textBaseline = "alphabetic";
  canvas.fillStyle = palette.floor;
  canvas.fillText(other.initials, x - width / 2, y - 5);
}

function paintTarget({ canvas, palette }: Brush, words: string, box: Box): void {
  canvas.font = TARGET_WORD;
  canvas.textAlign = "center";
  canvas.textBaseline = "alphabetic";
  canvas.lineWidth = 5;
  canvas.strokeStyle = palette.casing;
  const [x, y] = [(box.left + box.right) / 2, box.bottom + 20];
  canvas.strokeText(words, x, y);
  canvas.fillStyle = palette.logic;
  canvas.fillText(words, x, y);
}
