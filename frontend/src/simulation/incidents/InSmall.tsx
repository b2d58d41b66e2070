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
      let moved = false;
      for (const each of layer.current?.querySelectorAll<HTMLElement>("[data-robot]") ?? []) {
        const pose = poseAt(frames, each.dataset.robot ?? "", moment.t_s);
        const at = pose && toPixels([pose[0], pose[1]]);
        const to = at ? `${at.x.toFixed(1)}px ${at.y.toFixed(1)}px` : "";
        if (each.style.translate === to) continue;
        each.style.translate = to;
        moved = true;
      }
      return moved;
    });
    return () => loop.stop();
  }, [frames, moment, robots]);
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
