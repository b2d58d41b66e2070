/** A stroke that is being drawn, and what was measured last. */
import { PIXELS_PER_METRE, toPixels, type Point } from "@/map/plane/projection";
import { MeasuredLine } from "../map/measure/marks";
import styles from "./mapEdit.module.css";
import type { Settings } from "./tools";

interface StrokeProps {
  stroke: readonly Point[];
  settings: Settings;
  zoom: number;
}

export function StrokeShape({ stroke, settings, zoom }: StrokeProps) {
  const { tool } = settings;
  const [first, last] = [stroke[0], stroke.at(-1)];
  if (!first || !last || tool === "pan") return null;
  if (tool === "measure") return <MeasuredLine line={[first, last]} zoom={zoom} />;
  const pixels = stroke.map(toPixels);
  const [from, to] = [toPixels(first), toPixels(last)];
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
