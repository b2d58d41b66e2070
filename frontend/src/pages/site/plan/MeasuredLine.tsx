/** The line of known length over a picture: two ends that are dragged, or moved by the arrow keys. */
import type { KeyboardEvent, PointerEvent } from "react";
import { useTranslation } from "react-i18next";
import type { Picture, Pixel } from "./picture";
import styles from "./plan.module.css";

export type Line = readonly [Pixel, Pixel];

const KEYS: Readonly<Record<string, Pixel>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

function within({ width, height }: Picture, [x, y]: Pixel): Pixel {
  const clamp = (value: number, most: number) => Math.round(Math.min(most, Math.max(0, value)) * 10) / 10;
  return [clamp(x, width), clamp(y, height)];
}

interface LineProps {
  picture: Picture;
  line: Line;
  /** Pixels of the picture that a pixel of the screen is wide. */
  scale: number;
  change: (line: Line) => void;
}

export function MeasuredLine({ picture, line, scale, change }: LineProps) {
  const put = (end: 0 | 1, at: Pixel) => {
    const moved = within(picture, at);
    change(end === 0 ? [moved, line[1]] : [line[0], moved]);
  };
  const [[x1, y1], [x2, y2]] = line;
  return (
    <svg className={styles.line} viewBox={`0 0 ${String(picture.width)} ${String(picture.height)}`}>
      <line x1={x1} y1={y1} x2={x2} y2={y2} className={styles.casing} />
      <line x1={x1} y1={y1} x2={x2} y2={y2} className={styles.measure} />
      {([0, 1] as const).map((end) => (
        <End key={end} end={end} at={line[end]} scale={scale} put={(at) => put(end, at)} />
      ))}
    </svg>
  );
}

function End({ end, at, scale, put }: { end: 0 | 1; at: Pixel; scale: number; put: (at: Pixel) => void }) {
  const { t } = useTranslation();
  const drag = (event: PointerEvent<SVGGElement>) => {
    if (!event.currentTarget.hasPointerCapture(event.pointerId)) return;
    const matrix = event.currentTarget.ownerSVGElement?.getScreenCTM()?.inverse();
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    put([x, y]);
  };
  const press = (event: KeyboardEvent) => {
    const step = KEYS[event.key];
    if (!step) return;
    event.preventDefault();
    const pixels = event.shiftKey ? 20 : 1;
    put([at[0] + step[0] * pixels, at[1] + step[1] * pixels]);
  };
  return (
    <g
      transform={`translate(${String(at[0])} ${String(at[1])}) scale(${String(scale)})`}
      className={styles.end}
      role="button"
      tabIndex={0}
      aria-label={t(`mapEdit.plan.end${String(end)}`, { x: Math.round(at[0]), y: Math.round(at[1]) })}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={drag}
      onKeyDown={press}
    >
      <circle r={22} className={styles.reach} />
      <circle r={8} />
    </g>
  );
}
