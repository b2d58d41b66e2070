/** What keeps a map in small readable: its words as large as elsewhere, and the robots' names beside them. */
import { useStore } from "@xyflow/react";
import { useEffect, useRef } from "react";
import type { Device } from "@/api/types";
import { FrameLoop } from "@/map/plane/frameLoop";
import { toPixels } from "@/map/plane/projection";
import { poseAt, type Frames } from "@/scene3d/frames";
import styles from "./IncidentMarks.module.css";
import type { Moment } from "@/scene3d/types";

/** At this zoom words are as large as they are meant to be; smaller, they are enlarged up to so many times. */
const AS_MEANT = 0.87;
const MOST = 2.4;

export function onScreen(zoom: number): number {
  return Math.min(Math.max(AS_MEANT / zoom, 1), MOST);
}

/** A name's line, in drawing pixels. */
const LINE = 15;

interface Name {
  readonly x: number;
  readonly y: number;
  readonly width: number;
}

/** How many lines each name stands lower, so that those of robots close together do not lie over each other. */
export function linesOf(names: readonly Name[], height: number): number[] {
  const lines: number[] = [];
  for (const name of names) {
    const isTaken = (line: number) =>
      lines.some((other, index) => {
        const before = names[index];
        if (!before) return false;
        const across = Math.abs(before.x - name.x) < (before.width + name.width) / 2;
        return across && Math.abs(before.y + other * height - name.y - line * height) < height;
      });
    let line = 0;
    while (line < names.length && isTaken(line)) line += 1;
    lines.push(line);
  }
  return lines;
}

interface InSmallProps {
  robots: readonly Device[];
  frames: Frames;
  moment: Moment;
  /** What is said of a robot beside its name at the moment. */
  noteOf: (robot: string) => string;
}

export function InSmall(props: InSmallProps) {
  const { robots, frames, moment } = props;
  const scale = useStore(({ transform }) => onScreen(transform[2]));
  const layer = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const stage = layer.current?.closest<HTMLElement>("[data-map]");
    stage?.style.setProperty("--on-screen", scale.toFixed(3));
    stage?.toggleAttribute("data-small", scale > 1);
  }, [scale]);
  useEffect(() => {
    const loop = new FrameLoop(() => {
      const shown = [...(layer.current?.querySelectorAll<HTMLElement>("[data-robot]") ?? [])].flatMap((element) => {
        const pose = poseAt(frames, element.dataset.robot ?? "", moment.t_s);
        return pose ? [{ element, ...toPixels([pose[0], pose[1]]), width: element.offsetWidth * scale }] : [];
      });
      const lines = linesOf(shown, LINE * scale);
      let moved = false;
      shown.forEach(({ element, x, y }, index) => {
        const to = `${x.toFixed(1)}px ${(y + (lines[index] ?? 0) * LINE * scale).toFixed(1)}px`;
        if (element.style.translate === to) return;
        element.style.translate = to;
        moved = true;
      });
      return moved;
    });
    return () => loop.stop();
  }, [frames, moment, robots, scale]);
  return (
    <div ref={layer} className={styles.names} aria-hidden="true">
      {robots.map(({ id, name }) => (
        <span key={id} data-robot={id}>
          <b>{name}</b> {props.noteOf(id)}
        </span>
      ))}
    </div>
  );
}
