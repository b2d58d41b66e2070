/** A point on a picture that is dragged, or moved by the arrow keys (Shift: by 20 pixels). */
import type { KeyboardEvent, PointerEvent, ReactNode } from "react";
import type { Pixel } from "./picture";
import styles from "./plan.module.css";

const KEYS: Readonly<Record<string, Pixel>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** Put a point into a picture, to a tenth of a pixel. */
export function within({ width, height }: { width: number; height: number }, [x, y]: Pixel): Pixel {
  const clamp = (value: number, most: number) => Math.round(Math.min(most, Math.max(0, value)) * 10) / 10;
  return [clamp(x, width), clamp(y, height)];
}

interface HandleProps {
  at: Pixel;
  label: string;
  /** Pixels of the picture that a pixel of the screen is wide. */
  scale: number;
  put: (at: Pixel) => void;
  children: ReactNode;
}

export function Handle({ at, label, scale, put, children }: HandleProps) {
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
      aria-label={label}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={drag}
      onKeyDown={press}
    >
      <circle r={22} className={styles.reach} />
      {children}
    </g>
  );
}
