/** Lines of one pixel to the chips that a held chip stands in line with, with the distance. */
import { PIXELS_PER_METRE } from "@/map/projection";
import stage from "../canvas/stage.module.css";
import classes from "./gestures.module.css";
import type { Guide } from "./snapping";

export function Guides({ guides }: { guides: readonly Guide[] }) {
  if (guides.length === 0) return null;
  return (
    <svg className={stage.drawing} width={1} height={1} aria-hidden="true">
      {guides.map(({ from, to }, index) => (
        <g key={index} className={classes.guide}>
          <line x1={from.x} y1={from.y} x2={to.x} y2={to.y} />
          <text x={(from.x + to.x) / 2 + 5} y={(from.y + to.y) / 2 - 5}>
            {`${(Math.hypot(to.x - from.x, to.y - from.y) / PIXELS_PER_METRE).toFixed(1)}\u202fm`}
          </text>
        </g>
      ))}
    </svg>
  );
}
