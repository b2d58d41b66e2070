/** Live robots on canvases of their own: drawn each frame, outside React. */
import { useEffect, useRef } from "react";
import classes from "../map.module.css";
import { FrameLoop } from "../plane/frameLoop";
import { watchPalette, type Palette } from "../plane/palette";
import { paintRobots, paintWays, type IsTaken, type Moment } from "./robotPainter";
import { Trails, type RobotSource, type RobotView } from "./robots";
import { paintOnce } from "../plane/useCanvas";
import type { ViewportSource } from "../plane/viewport";

interface LayerProps {
  source: RobotSource;
  viewport: ViewportSource;
}

/** Where robots go, and with trails where they have been. */
export function RobotPaths({ source, viewport, trails = false }: LayerProps & { trails?: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const past = trails && !prefersStill() ? new Trails() : null;
    return animate(canvas.current, source, viewport, {
      fading: past !== null,
      paint: (each, colours, moment) => paintWays(each, colours, moment, past),
      look: (robots, now) => robots.forEach((robot) => past?.add(robot, now)),
    });
  }, [source, viewport, trails]);
  return <canvas ref={canvas} className={classes.layer} aria-hidden="true" />;
}

/** The robots with their names, which keep off what is taken. */
export function RobotLayer({ source, viewport, isTaken }: LayerProps & { isTaken: IsTaken }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(
    () =>
      animate(canvas.current, source, viewport, {
        fading: false,
        paint: (each, colours, moment) => paintRobots(each, colours, moment, isTaken),
      }),
    [source, viewport, isTaken],
  );
  return <canvas ref={canvas} className={classes.layer} aria-hidden="true" />;
}

interface Painting {
  /** Something of it fades with time though no robot moves. */
  readonly fading: boolean;
  readonly paint: (canvas: CanvasRenderingContext2D, palette: Palette, moment: Moment) => void;
  readonly look?: (robots: readonly RobotView[], now: number) => void;
}

function prefersStill(): boolean {
  return window.matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** Paints only frames in which something changed; once a second where motion is not wanted. */
function animate(
  element: HTMLCanvasElement | null,
  source: RobotSource,
  viewport: ViewportSource,
  painting: Painting,
): (() => void) | undefined {
  const context = element?.getContext("2d");
  if (!element || !context) return undefined;
  const still = prefersStill();
  let palette: Palette | null = null;
  let painted = "";
  const loop = new FrameLoop((now) => {
    const time = still ? Math.floor(now / 1000) * 1000 : now;
    const robots = source(time);
    painting.look?.(robots, now);
    const wanted = fingerprint(robots, viewport, element, time, painting.fading);
    if (!palette || wanted === painted) return false;
    painted = wanted;
    const moment = { robots, viewport: viewport.get(), now };
    paintOnce(element, context, (each, _size, colours) => painting.paint(each, colours, moment), palette);
    return true;
  });
  const stopPalette = watchPalette((next) => {
    palette = next;
    painted = "";
    loop.wake();
  });
  const stopViewport = viewport.subscribe(loop.wake);
  const resize = new ResizeObserver(loop.wake);
  resize.observe(element);
  return () => {
    stopPalette();
    stopViewport();
    resize.disconnect();
    loop.stop();
  };
}

function fingerprint(
  robots: readonly RobotView[],
  viewport: ViewportSource,
  element: HTMLCanvasElement,
  now: number,
  fading: boolean,
): string {
  const view = viewport.get();
  const moving = robots.some((robot) => robot.status === "busy");
  const parts = robots.map((robot) => {
    const path = `${robot.route?.length ?? 0},${robot.reserved?.[0]?.join() ?? ""}`;
    const pose = `${robot.x.toFixed(3)},${robot.y.toFixed(3)},${robot.theta.toFixed(2)}`;
    const copy = [robot.copy, robot.real].map((at) => (at ? `${at.x.toFixed(2)},${at.y.toFixed(2)}` : "")).join();
    return `${robot.id},${copy},${pose},${robot.status},${robot.note ?? ""},${robot.wait ?? ""},${robot.carrying},${path}`;
  });
  const time = moving ? now : fading ? Math.floor(now / 500) : 0;
  return `${view.x},${view.y},${view.zoom},${element.clientWidth},${element.clientHeight},${time};${parts.join(";")}`;
}
