/** The view of a map that fits its pane until somebody zooms: by wheel, buttons or, once nearer, by dragging it. */
import { type PointerEvent, useRef, useState } from "react";
import type { Viewport } from "@/map/plane/projection";
import { useWheelZoom } from "@/map/plane/useWheelZoom";
import type { Fitted } from "@/map/StaticMap";
import { kept, zoomedAt } from "./zoomed";

const STEP = 1.4;
/** Until it is known how the map fits. */
const WHOLE: Viewport = { x: 0, y: 0, zoom: 1 };

export type ZoomedView = ReturnType<typeof useZoomedView>;

export function useZoomedView() {
  const surface = useRef<SVGSVGElement>(null);
  const [fitted, report] = useState<Fitted | null>(null);
  const [own, setOwn] = useState<{ view: Viewport; fit: Viewport } | null>(null);
  const fit = fitted?.fit ?? WHOLE;
  const { width, height } = fitted ?? { width: 0, height: 0 };
  // Of a pane or map that is another by now nothing is left.
  const view = own?.fit === fit ? own.view : fit;
  const put = (next: Viewport | null) => setOwn(next && fitted && { view: kept(next, fitted.frame, fitted), fit });
  const zoomAt = (factor: number, x = width / 2, y = height / 2) => put(zoomedAt(view, fit, factor, x, y));

  useWheelZoom(surface, (factor, x, y) => {
    if (factor <= 1 && view === fit) return false;
    zoomAt(factor, x, y);
    return true;
  });

  const held = useRef<{ pointer: number; x: number; y: number } | null>(null);
  const isNearer = view !== fit;
  /** The floor itself is taken by the main button, everything by the middle one. */
  const grab = (event: PointerEvent<SVGSVGElement>) => {
    const isMine = event.button === 1 || (event.button === 0 && event.target === event.currentTarget);
    if (!isNearer || !isMine) return;
    event.preventDefault();
    event.stopPropagation();
    event.currentTarget.setPointerCapture(event.pointerId);
    held.current = { pointer: event.pointerId, x: event.clientX, y: event.clientY };
  };
  const drag = (event: PointerEvent<SVGSVGElement>) => {
    const { current } = held;
    if (current?.pointer !== event.pointerId) return;
    put({ ...view, x: view.x + event.clientX - current.x, y: view.y + event.clientY - current.y });
    held.current = { pointer: event.pointerId, x: event.clientX, y: event.clientY };
  };
  const drop = () => {
    held.current = null;
  };
  return {
    surface,
    report,
    of: fit,
    view,
    isNearer,
    zoomIn: () => zoomAt(STEP),
    zoomOut: () => zoomAt(1 / STEP),
    fit: () => setOwn(null),
    pointer: {
      onPointerDownCapture: grab,
      onPointerMove: drag,
      onPointerUp: drop,
      onPointerCancel: drop,
    },
  };
}
