/** The line that follows the pointer from the source, and the planned route once the target is known. */
import { useEffect, useRef } from "react";
import { PathLine } from "@/map/PathLine";
import type { PixelPoint } from "@/map/plane/paths";
import type { ViewportCell } from "@/map/plane/viewport";
import stage from "@/program/canvas/stage.module.css";

export function PreviewLine({
  from,
  route,
  pointer,
}: {
  from: PixelPoint | null;
  route: readonly PixelPoint[] | null;
  pointer: ViewportCell;
}) {
  const line = useRef<SVGLineElement>(null);
  useEffect(() => {
    const follow = () => {
      const { x, y } = pointer.get();
      line.current?.setAttribute("x2", String(x));
      line.current?.setAttribute("y2", String(y));
    };
    follow();
    return pointer.subscribe(follow);
  }, [pointer, from]);
  if (!from && !route) return null;
  return (
    <svg className={stage.drawing} width={1} height={1} aria-hidden="true">
      {route ? <PathLine points={route} opacity={0.8} /> : null}
      {from ? (
        <line
          ref={line}
          x1={from.x}
          y1={from.y}
          x2={from.x}
          y2={from.y}
          stroke="var(--motion)"
          strokeWidth={3}
          strokeDasharray="8 6"
          strokeLinecap="round"
        />
      ) : null}
    </svg>
  );
}
