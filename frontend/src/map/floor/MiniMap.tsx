/** The whole floor in small, with the part that the big map shows; a press or drag goes there. */
import { useCallback, useEffect, useMemo, useState, type PointerEvent } from "react";
import { knownBox, type FloorPlan } from "./floor";
import { FloorCanvas } from "./FloorCanvas";
import classes from "../map.module.css";
import type { Palette } from "../plane/palette";
import { type PixelPoint, roundedPath } from "../plane/paths";
import { fitViewport, type Viewport } from "../plane/projection";
import { useCanvas } from "../plane/useCanvas";
import { useSize } from "../plane/useSize";
import { ViewportCell, type ViewportSource } from "../plane/viewport";

const BARE = { rulers: false, labels: false, grid: false };

export interface MiniMapProps {
  plan: FloorPlan | null;
  /** What the big map shows, and how large its pane is. */
  viewport: ViewportSource;
  pane: { width: number; height: number };
  /** The point of the drawing plane to bring to the middle. */
  onGo: (point: { x: number; y: number }) => void;
  label: string;
  /** Lines over the floor, drawing pixels. */
  lines: readonly (readonly PixelPoint[])[];
}

export function MiniMap({ plan, viewport, pane, onGo, label, lines }: MiniMapProps) {
  const [element, { width, height }] = useSize<HTMLDivElement>();
  const [cell] = useState(() => new ViewportCell());
  const view = useMemo<Viewport>(() => {
    if (!plan || width === 0) return { x: 0, y: 0, zoom: 1 };
    return fitViewport(knownBox(plan), width, height, { left: 6, top: 6, right: 6, bottom: 6 });
  }, [plan, width, height]);
  useEffect(() => cell.set(view), [cell, view]);
  const go = (event: PointerEvent<HTMLDivElement>) => {
    if (event.buttons !== 1) return;
    const box = event.currentTarget.getBoundingClientRect();
    onGo({
      x: (event.clientX - box.left - view.x) / view.zoom,
      y: (event.clientY - box.top - view.y) / view.zoom,
    });
  };
  return (
    <div ref={element} className={classes.miniMap} role="img" aria-label={label} onPointerDown={go} onPointerMove={go}>
      <FloorCanvas plan={plan} viewport={cell} detail={BARE} />
      <Lines lines={lines} viewport={cell} />
      <svg className={classes.still} aria-hidden="true">
        <g transform={`translate(${view.x} ${view.y}) scale(${view.zoom})`}>
          <Frame viewport={viewport} pane={pane} scale={view.zoom} />
        </g>
      </svg>
    </div>
  );
}

/** A canvas of its own, so that it rests while the frame of the big map's view moves over it. */
function Lines({ lines, viewport }: { lines: MiniMapProps["lines"]; viewport: ViewportSource }) {
  const paint = useCallback(
    (context: CanvasRenderingContext2D, _size: unknown, palette: Palette) => {
      const { x, y, zoom } = viewport.get();
      context.translate(x, y);
      context.scale(zoom, zoom);
      context.strokeStyle = palette.motion;
      context.globalAlpha = 0.6;
      context.lineWidth = LINE;
      for (const line of lines) context.stroke(new Path2D(roundedPath(line)));
      context.globalAlpha = 1;
    },
    [lines, viewport],
  );
  return <canvas ref={useCanvas(paint, viewport)} className={classes.layer} aria-hidden="true" />;
}

/** Drawing pixels. */
const LINE = 8;

function Frame({
  viewport,
  pane,
  scale,
}: {
  viewport: ViewportSource;
  pane: { width: number; height: number };
  scale: number;
}) {
  const [view, setView] = useState(() => viewport.get());
  useEffect(() => viewport.subscribe(() => setView(viewport.get())), [viewport]);
  return (
    <rect
      x={-view.x / view.zoom}
      y={-view.y / view.zoom}
      width={pane.width / view.zoom}
      height={pane.height / view.zoom}
      rx={5 / scale}
      fill="var(--brand)"
      fillOpacity={0.06}
      stroke="var(--brand)"
      strokeWidth={1.5 / scale}
    />
  );
}
