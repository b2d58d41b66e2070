/** Live robots on a canvas of their own: drawn each frame, outside React. */
import { useEffect, useRef } from "react";
import classes from "./map.module.css";
import { watchPalette, type Palette } from "./palette";
import { paintRobots } from "./robotPainter";
import { Trails, type RobotSource, type RobotView } from "./robots";
import { paintOnce } from "./useCanvas";
import type { ViewportSource } from "./viewport";

export interface RobotLayerProps {
  source: RobotSource;
  viewport: ViewportSource;
  names?: boolean;
  trails?: boolean;
}

export function RobotLayer({ source, viewport, names = true, trails = false }: RobotLayerProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const element = canvas.current;
    const context = element?.getContext("2d");
    if (!element || !context) return;
    return animate(element, context, source, viewport, { names, trails });
  }, [source, viewport, names, trails]);
  return <canvas ref={canvas} className={classes.layer} aria-hidden="true" />;
}

/** Paints only frames in which something changed; once a second where motion is not wanted. */
function animate(
  element: HTMLCanvasElement,
  context: CanvasRenderingContext2D,
  source: RobotSource,
  viewport: ViewportSource,
  detail: { names: boolean; trails: boolean },
): () => void {
  const trails = new Trails();
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  let palette: Palette | null = null;
  let painted = "";
  let frame = 0;
  const stopPalette = watchPalette((next) => {
    palette = next;
    painted = "";
  });
  const step = (now: number) => {
    frame = requestAnimationFrame(step);
    const time = still ? Math.floor(now / 1000) * 1000 : now;
    const robots = source(time);
    if (detail.trails && !still) for (const robot of robots) trails.add(robot, now);
    const wanted = fingerprint(robots, viewport, element, time, detail.trails);
    if (!palette || wanted === painted) return;
    painted = wanted;
    paintOnce(
      element,
      context,
      (each, _size, colours) => paintRobots(each, colours, robots, trails, viewport.get(), now, detail),
      palette,
    );
  };
  frame = requestAnimationFrame(step);
  return () => {
    stopPalette();
    cancelAnimationFrame(frame);
  };
}

function fingerprint(
  robots: readonly RobotView[],
  viewport: ViewportSource,
  element: HTMLCanvasElement,
  now: number,
  trails: boolean,
): string {
  const view = viewport.get();
  const moving = robots.some((robot) => robot.status === "busy");
  const parts = robots.map((robot) => {
    const way = `${robot.route?.length ?? 0},${robot.reserved?.[0] ?? ""}`;
    const pose = `${robot.x.toFixed(3)},${robot.y.toFixed(3)},${robot.theta.toFixed(2)}`;
    return `${robot.id},${pose},${robot.status},${robot.note ?? ""},${robot.wait ?? ""},${robot.carrying},${way}`;
  });
  const time = moving ? now : trails ? Math.floor(now / 500) : 0;
  return `${view.x},${view.y},${view.zoom},${element.clientWidth},${element.clientHeight},${time};${parts.join(";")}`;
}
