/** Paints live robots: reserved path, trail, body, ring, what they carry and why they wait. */
import i18next from "i18next";
import type { Palette } from "../plane/palette";
import { toPixels, type Box, type Point, type Viewport } from "../plane/projection";
import { apartOf, type Pose, type RobotView, type TrailPoint, type Trails } from "./robots";

type Canvas = CanvasRenderingContext2D;

const NAME = "600 11.5px 'Inter Variable', Inter, sans-serif";
const NOTE = "11px 'Inter Variable', Inter, sans-serif";
const RADIUS = 19;

export interface Moment {
  readonly robots: readonly RobotView[];
  readonly viewport: Viewport;
  readonly now: number;
}

/** Where robots go and have been; belongs under the steps of a program. */
export function paintWays(canvas: Canvas, palette: Palette, moment: Moment, trails: Trails | null): void {
  const { robots, viewport, now } = moment;
  canvas.save();
  canvas.translate(viewport.x, viewport.y);
  canvas.scale(viewport.zoom, viewport.zoom);
  for (const robot of robots) paintWay(canvas, palette, robot);
  for (const robot of robots) paintCopy(canvas, palette, robot);
  for (const robot of robots) if (robot.real) paintReal(canvas, palette, robot.real, robot);
  if (trails) for (const robot of robots) paintTrail(canvas, palette, trails.of(robot.id, now));
  canvas.restore();
}

/** Tells whether something stands in a box of the drawing plane. */
export type IsTaken = (box: Box) => boolean;

/** The robots themselves; their names keep off what is taken. */
export function paintRobots(canvas: Canvas, palette: Palette, moment: Moment, isTaken: IsTaken): void {
  const { robots, viewport, now } = moment;
  canvas.save();
  canvas.translate(viewport.x, viewport.y);
  canvas.scale(viewport.zoom, viewport.zoom);
  for (const robot of robots) paintRobot(canvas, palette, robot, now, viewport.zoom > 0.45 ? isTaken : null);
  canvas.restore();
}

function paintWay(canvas: Canvas, palette: Palette, robot: RobotView): void {
  const waiting = Boolean(robot.wait);
  const colour = waiting ? palette["warn-fill"] : palette.busy;
  if (robot.reserved && robot.reserved.length > 1) {
    line(canvas, robot.reserved);
    canvas.lineWidth = 18;
    canvas.strokeStyle = colour;
    canvas.globalAlpha = 0.16;
    canvas.stroke();
    canvas.globalAlpha = 1;
  }
  if (!robot.route || robot.route.length < 2) return;
  line(canvas, robot.route);
  canvas.setLineDash([7, 6]);
  canvas.lineWidth = 2.6;
  canvas.strokeStyle = colour;
  canvas.stroke();
  canvas.setLineDash([]);
}

function line(canvas: Canvas, points: readonly Point[]): void {
  canvas.beginPath();
  canvas.lineJoin = "round";
  canvas.lineCap = "round";
  points.forEach((point, index) => {
    const at = toPixels(point);
    if (index === 0) canvas.moveTo(at.x, at.y);
    else canvas.lineTo(at.x, at.y);
  });
}

/** Where the copy of a robot is that is not where the robot is, and how far that is. */
function paintCopy(canvas: Canvas, palette: Palette, { copy, x, y }: RobotView): void {
  if (!copy || apartOf(copy, { x, y }) === null) return;
  const [from, to] = [toPixels([x, y]), toPixels([copy.x, copy.y])];
  canvas.strokeStyle = palette["text-3"];
  canvas.lineWidth = 1.6;
  canvas.setLineDash([3, 4]);
  canvas.beginPath();
  canvas.moveTo(from.x, from.y);
  canvas.lineTo(to.x, to.y);
  canvas.stroke();
  canvas.beginPath();
  canvas.arc(to.x, to.y, RADIUS - 4, 0, Math.PI * 2);
  canvas.stroke();
  canvas.setLineDash([]);
}

/** Where the real robot stands while a simulated one drives; nothing where one covers the other. */
function paintReal(canvas: Canvas, palette: Palette, real: Pose, robot: RobotView): void {
  if (apartOf(real, robot) === null) return;
  const at = toPixels([real.x, real.y]);
  canvas.save();
  canvas.translate(at.x, at.y);
  canvas.globalAlpha = 0.55;
  paintBody(canvas, palette, real.theta);
  canvas.globalAlpha = 1;
  canvas.strokeStyle = palette["text-3"];
  canvas.lineWidth = 1.6;
  canvas.setLineDash([3, 4]);
  canvas.beginPath();
  canvas.arc(0, 0, RADIUS, 0, Math.PI * 2);
  canvas.stroke();
  canvas.setLineDash([]);
  canvas.font = NOTE;
  canvas.textAlign = "center";
  canvas.fillStyle = palette["text-2"];
  canvas.fillText(i18next.t("device.standIn.body"), 0, RADIUS + 15);
  canvas.restore();
}

function paintTrail(canvas: Canvas, palette: Palette, trail: readonly TrailPoint[]): void {
  canvas.strokeStyle = palette.busy;
  canvas.lineWidth = 5;
  canvas.lineCap = "butt";
  for (let index = 1; index < trail.length; index += 1) {
    const [a, b] = [trail[index - 1], trail[index]];
    if (!a || !b?.seen) continue;
    canvas.globalAlpha = 0.55 * b.fresh;
    canvas.beginPath();
    const [from, to] = [toPixels([a.x, a.y]), toPixels([b.x, b.y])];
    canvas.moveTo(from.x, from.y);
    canvas.lineTo(to.x, to.y);
    canvas.stroke();
  }
  canvas.globalAlpha = 1;
}

function paintRobot(canvas: Canvas, palette: Palette, robot: RobotView, now: number, isTaken: IsTaken | null): void {
  const at = toPixels([robot.x, robot.y]);
  canvas.save();
  canvas.translate(at.x, at.y);
  if (robot.status === "offline") canvas.globalAlpha = 0.7;
  paintRing(canvas, palette, robot, now);
  paintBody(canvas, palette, robot.theta);
  if (robot.carrying) paintLoad(canvas, palette);
  paintBadge(canvas, palette, robot.status);
  if (isTaken) paintName(canvas, palette, robot, nameHeight(robot, isTaken));
  canvas.restore();
}

function paintRing(canvas: Canvas, palette: Palette, robot: RobotView, now: number): void {
  const { status } = robot;
  canvas.beginPath();
  canvas.arc(0, 0, RADIUS, 0, Math.PI * 2);
  canvas.fillStyle = palette.floor;
  canvas.globalAlpha *= 0.8;
  canvas.fill();
  canvas.globalAlpha = status === "offline" ? 0.7 : 1;
  canvas.strokeStyle = ringColour(palette, status);
  canvas.lineWidth = status === "done" ? 2.6 : status === "busy" ? 3.2 : 1.6;
  const dash = { waiting: [7, 4], offline: [2, 3.2], pending: [0.1, 4.4] }[status as string];
  canvas.setLineDash(dash ?? []);
  if (status === "busy") {
    const start = (now / 1600) * Math.PI * 2;
    canvas.beginPath();
    canvas.arc(0, 0, RADIUS, start, start + Math.PI * 1.4);
  }
  canvas.stroke();
  canvas.setLineDash([]);
  if (status !== "error") return;
  canvas.beginPath();
  canvas.arc(0, 0, RADIUS - 4, 0, Math.PI * 2);
  canvas.stroke();
}

function ringColour(palette: Palette, status: RobotView["status"]): string {
  const colours = {
    idle: palette.idle,
    busy: palette.busy,
    done: palette.done,
    waiting: palette.warn,
    warning: palette.idle,
    error: palette.error,
    offline: palette.offline,
    pending: palette.pend,
  };
  return colours[status];
}

function paintBody(canvas: Canvas, palette: Palette, theta: number): void {
  canvas.save();
  canvas.rotate(-theta);
  canvas.lineWidth = 1.6;
  canvas.strokeStyle = palette["text-2"];
  canvas.fillStyle = palette.panel;
  canvas.beginPath();
  canvas.arc(0, 0, 14, 0, Math.PI * 2);
  canvas.fill();
  canvas.stroke();
  canvas.strokeStyle = palette.text;
  canvas.beginPath();
  canvas.arc(0, 0, 4.4, 0, Math.PI * 2);
  canvas.moveTo(4.4, 0);
  canvas.lineTo(14, 0);
  canvas.moveTo(-2.4, 3.8);
  canvas.lineTo(-7.6, 11);
  canvas.moveTo(-2.4, -3.8);
  canvas.lineTo(-7.6, -11);
  canvas.stroke();
  canvas.fillStyle = palette.text;
  canvas.beginPath();
  canvas.moveTo(15.5, -5);
  canvas.lineTo(22, 0);
  canvas.lineTo(15.5, 5);
  canvas.closePath();
  canvas.fill();
  canvas.restore();
}

function paintLoad(canvas: Canvas, palette: Palette): void {
  canvas.fillStyle = palette.brand;
  canvas.beginPath();
  canvas.roundRect(-22, -24, 14, 14, 4);
  canvas.fill();
  canvas.strokeStyle = palette.floor;
  canvas.lineWidth = 1.4;
  canvas.strokeRect(-18.5, -20.5, 7, 7);
}

function paintBadge(canvas: Canvas, palette: Palette, status: RobotView["status"]): void {
  if (status === "waiting") {
    canvas.fillStyle = palette["warn-fill"];
    canvas.beginPath();
    canvas.roundRect(7, 7, 14, 14, 3.6);
    canvas.fill();
    canvas.fillStyle = "#171b26";
    canvas.fillRect(10.8, 10.6, 2, 7);
    canvas.fillRect(15, 10.6, 2, 7);
  }
  if (status === "error") {
    canvas.fillStyle = palette.error;
    canvas.beginPath();
    canvas.arc(14, 14, 7.5, 0, Math.PI * 2);
    canvas.fill();
    canvas.fillStyle = palette.panel;
    canvas.fillRect(13, 9.8, 2, 5);
    canvas.fillRect(13, 16.2, 2, 2);
  }
}

/** Why a robot waits is read wherever it stands, over walls and zones, too. */
function paintCard(canvas: Canvas, palette: Palette, name: string, wait: string, height: number): void {
  canvas.font = NAME;
  const first = canvas.measureText(name).width;
  canvas.font = NOTE;
  const width = Math.max(first, canvas.measureText(wait).width) + 16;
  canvas.beginPath();
  canvas.roundRect(-width / 2, height - 14, width, 35, 6);
  canvas.fillStyle = palette.panel;
  canvas.fill();
  canvas.strokeStyle = palette["warn-fill"];
  canvas.lineWidth = 1.2;
  canvas.stroke();
}

const NAME_BELOW = 38;
const NAME_ABOVE = -42;

/** Below the robot, or above it where something is in the way below and nothing above. */
export function nameHeight(robot: RobotView, isTaken: IsTaken): number {
  const at = toPixels([robot.x, robot.y]);
  const half = (Math.max(robot.name.length, (robot.wait ?? robot.note ?? "").length) * 6.4) / 2;
  const covers = (height: number) =>
    isTaken({ left: at.x - half, right: at.x + half, top: at.y + height - 11, bottom: at.y + height + 18 });
  return covers(NAME_BELOW) && !covers(NAME_ABOVE) ? NAME_ABOVE : NAME_BELOW;
}

function paintName(canvas: Canvas, palette: Palette, robot: RobotView, height: number): void {
  canvas.textAlign = "center";
  canvas.textBaseline = "alphabetic";
  canvas.lineJoin = "round";
  if (robot.wait) paintCard(canvas, palette, robot.name, robot.wait, height);
  canvas.strokeStyle = palette.casing;
  canvas.lineWidth = 4;
  canvas.font = NAME;
  canvas.strokeText(robot.name, 0, height);
  canvas.fillStyle = palette.text;
  canvas.fillText(robot.name, 0, height);
  const note = robot.wait ?? robot.note;
  if (!note) return;
  canvas.font = NOTE;
  canvas.strokeText(note, 0, height + 14);
  canvas.fillStyle = robot.wait ? palette.warn : palette["text-3"];
  canvas.fillText(note, 0, height + 14);
}
