/** A stroke that is being drawn, and what was measured last. */
import { formatNumber, withUnit } from "@/i18n/format";
import { PIXELS_PER_METRE, toPixels, type Point } from "@/map/plane/projection";
import styles from "./mapEdit.module.css";
import type { Settings } from "./tools";

interface StrokeProps {
  stroke: readonly Point[];
  settings: Settings;
  zoom: number;
}

export function StrokeShape({ stroke, settings, zoom }: StrokeProps) {
  const { tool } = settings;
  const pixels = stroke.map(toPixels);
  const [from, to] = [pixels[0], pixels.at(-1)];
  if (!from || !to || tool === "pan") return null;
  if (tool === "measure") return <Measure from={from} to={to} zoom={zoom} length={lengthOf(stroke)} />;
  if (tool === "box" || tool === "crop")
    return (
      <rect
        className={styles.box}
        data-material={tool === "crop" ? "crop" : settings.material.box}
        x={Math.min(from.x, to.x)}
        y={Math.min(from.y, to.y)}
        width={Math.abs(to.x - from.x)}
        height={Math.abs(to.y - from.y)}
      />
    );
  return (
    <polyline
      className={styles.stroke}
      data-material={settings.material[tool]}
      points={[...pixels, to].map(({ x, y }) => `${String(x)},${String(y)}`).join(" ")}
      strokeWidth={settings.width[tool] * PIXELS_PER_METRE}
    />
  );
}

/** Metres from the first point of a stroke to its last. */
export function lengthOf(stroke: readonly Point[]): number {
  const [from, to] = [stroke[0], stroke.at(-1)];
  return from && to ? Math.hypot(to[0] - from[0], to[1] - from[1]) : 0;
}

interface Plane {
  x: number;
  y: number;
}

function Measure({ from, to, zoom, length }: { from: Plane; to: Plane; zoom: number; length: number }) {
  const middle = { x: (from.x + to.x) / 2, y: (from.y + to.y) / 2 };
  return (
    <g className={styles.measure}>
      <line x1={from.x} y1={from.y} x2={to.x} y2={to.y} />
      <circle cx={from.x} cy={from.y} r={5 / zoom} />
      <circle cx={to.x} cy={to.y} r={5 / zoom} />
      <g transform={`translate(${String(middle.x)} ${String(middle.y)}) scale(${String(1 / zoom)})`}>
        <rect x={-34} y={-32} width={68} height={24} rx={7} />
        <text y={-16}>{withUnit(formatNumber(length, 2), "m")}</text>
      </g>
    </g>
  );
}
