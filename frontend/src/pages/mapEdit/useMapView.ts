/** What part of the map is seen: fitted at first, then moved by wheel, keys and hand. */
import { useEffect, useRef, useState } from "react";
import { planBox, type FloorPlan } from "@/map/floor/floor";
import { fitViewport, PIXELS_PER_METRE, type Point, type Viewport } from "@/map/plane/projection";
import { ViewportCell } from "@/map/plane/viewport";

const [LEAST_ZOOM, MOST_ZOOM] = [0.01, 40];
const MARGIN = { left: 72, right: 24, top: 24, bottom: 24 };

export function useMapView(plan: FloorPlan, width: number, height: number) {
  const [cell] = useState(() => new ViewportCell());
  const [view, setView] = useState<Viewport>(cell.get());
  const shape = `${String(plan.width)} ${String(plan.height)} ${String(plan.resolution_m)} ${String(plan.origin.x)}`;
  const fitted = useRef("");
  const put = (next: Viewport) => {
    cell.set(next);
    setView(next);
  };
  const fit = () => put(fitViewport(planBox(plan), width, height, MARGIN, MOST_ZOOM));
  useEffect(() => {
    const wanted = `${shape} ${String(width)} ${String(height)}`;
    if (width === 0 || fitted.current === wanted) return;
    fitted.current = wanted;
    const next = fitViewport(planBox(plan), width, height, MARGIN, MOST_ZOOM);
    cell.set(next);
    setView(next);
  }, [shape, width, height, plan, cell]);
  const zoomAt = (factor: number, x = width / 2, y = height / 2) => {
    const zoom = Math.min(MOST_ZOOM, Math.max(LEAST_ZOOM, view.zoom * factor));
    const by = zoom / view.zoom;
    put({ zoom, x: x - (x - view.x) * by, y: y - (y - view.y) * by });
  };
  return {
    cell,
    view,
    fit,
    zoomAt,
    panBy: (dx: number, dy: number) => put({ ...view, x: view.x + dx, y: view.y + dy }),
    /** Metres at a point of the pane. */
    pointAt: (x: number, y: number): Point => [
      (x - view.x) / view.zoom / PIXELS_PER_METRE,
      -(y - view.y) / view.zoom / PIXELS_PER_METRE,
    ],
  };
}

export type MapView = ReturnType<typeof useMapView>;
