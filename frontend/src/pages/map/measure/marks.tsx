/** What is drawn on a map while somebody measures, as large at any zoom. */
import { toPixels, type Box, type Point } from "@/map/plane/projection";
import { metres } from "../check/findingWords";
import { LABEL, labelMiddle, lengthOf, type Line } from "./measuring";
import styles from "./measure.module.css";

interface MeasuredLineProps {
  line: Line;
  zoom: number;
  /** What of the plane is seen, in drawing pixels: the label stays in it. */
  frame?: Box | null;
}

/** A line between two open ends, with its length. */
export function MeasuredLine({ line, zoom, frame = null }: MeasuredLineProps) {
  const [a, b] = [toPixels(line[0]), toPixels(line[1])];
  const { halfWidth, halfHeight } = LABEL;
  return (
    <g className={styles.line}>
      <line x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
      <End at={line[0]} zoom={zoom} />
      <End at={line[1]} zoom={zoom} />
      <g transform={placed(labelMiddle(a, b, zoom, frame), zoom)}>
        <rect x={-halfWidth} y={-halfHeight} width={2 * halfWidth} height={2 * halfHeight} rx={7} />
        <text dominantBaseline="central">{metres(lengthOf(line))}</text>
      </g>
    </g>
  );
}

export function End({ at, zoom }: { at: Point; zoom: number }) {
  const { x, y } = toPixels(at);
  return <circle className={styles.end} cx={x} cy={y} r={5 / zoom} />;
}

/** Where the keys aim. */
export function CrossHair({ at, zoom }: { at: Point; zoom: number }) {
  return (
    <g transform={placed(toPixels(at), zoom)} className={styles.cross}>
      <path d="M-14 0H-3M3 0H14M0 -14V-3M0 3V14" />
    </g>
  );
}

function placed({ x, y }: { x: number; y: number }, zoom: number): string {
  return `translate(${String(x)} ${String(y)}) scale(${String(1 / zoom)})`;
}
