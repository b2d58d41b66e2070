/** A map with points on it that can be moved; a pixel of its picture is a cell. */
import { useEffect, useRef } from "react";
import { useSize } from "@/map/plane/useSize";
import type { CellMap } from "@/map/floor/rosFiles";
import { Handle, within } from "../plan/Handle";
import { paintCells } from "../plan/paintCells";
import type { Pixel } from "../plan/picture";
import styles from "./align.module.css";

interface PaneProps {
  map: CellMap;
  title: string;
  points?: readonly Pixel[];
  labelOf?: (index: number, at: Pixel) => string;
  put?: (index: number, at: Pixel) => void;
}

export function MapPane({ map, title, points = [], labelOf, put }: PaneProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [element, { width }] = useSize<HTMLDivElement>();
  useEffect(() => {
    if (canvas.current) paintCells(canvas.current, map);
  }, [map]);
  const scale = width ? map.width / width : 1;
  const ratio = map.width / map.height;
  return (
    <figure className={styles.pane}>
      <figcaption>{title}</figcaption>
      <div ref={element} className={styles.picture} style={{ aspectRatio: ratio, maxWidth: `${String(68 * ratio)}vh` }}>
        <canvas ref={canvas} role="img" aria-label={title} />
        <svg viewBox={`0 0 ${String(map.width)} ${String(map.height)}`}>
          {points.map((at, index) => (
            <Handle
              key={index}
              at={at}
              label={labelOf?.(index, at) ?? ""}
              scale={scale}
              put={(next) => put?.(index, within(map, next))}
            >
              <circle r={11} />
              <text className={styles.number}>{index + 1}</text>
            </Handle>
          ))}
        </svg>
      </div>
    </figure>
  );
}
