/** The view of a map that fits its pane until somebody zooms, by wheel or buttons; once nearer, drags and keys move it. */
import { type FocusEvent, type KeyboardEvent, type PointerEvent, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Viewport } from "@/map/plane/projection";
import { useWheelZoom } from "@/map/plane/useWheelZoom";
import type { Fitted } from "@/map/StaticMap";
import { kept, showing, zoomedAt } from "./zoomed";

const STEP = 1.4;
/** So much (pixels) of the pane’s lower edge is covered by the buttons and the layers. */
const CONTROLS = 44;
/** How far (pixels) an arrow key moves a map that is seen from nearer. */
const BY_KEY = 60;
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [1, 0],
  ArrowRight: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
/** Until it is known how the map fits. */
const WHOLE: Viewport = { x: 0, y: 0, zoom: 1 };

export type ZoomedView = ReturnType<typeof useZoomedView>;

export function useZoomedView() {
  const { t } = useTranslation();
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

  const held = useRef<{ pointer: number; x: number; y: number; from: Viewport } | null>(null);
  const isNearer = view !== fit;
  /** The floor itself is taken by the main button, everything by the middle one. */
  const grab = (event: PointerEvent<SVGSVGElement>) => {
    const isMine = event.button === 1 || (event.button === 0 && event.target === event.currentTarget);
    if (!isNearer || !isMine) return;
    event.preventDefault();
    event.stopPropagation();
    event.currentTarget.setPointerCapture(event.pointerId);
    held.current = { pointer: event.pointerId, x: event.clientX, y: event.clientY, from: view };
  };
  const drag = (event: PointerEvent<SVGSVGElement>) => {
    const { current } = held;
    if (current?.pointer !== event.pointerId) return;
    const { from, x, y } = current;
    put({ ...from, x: from.x + event.clientX - x, y: from.y + event.clientY - y });
  };
  const drop = () => {
    held.current = null;
  };
  const pan = (event: KeyboardEvent<SVGSVGElement>) => {
    const way = ARROWS[event.key];
    if (!isNearer || !way || event.target !== event.currentTarget) return;
    event.preventDefault();
    put({ ...view, x: view.x + way[0] * BY_KEY, y: view.y + way[1] * BY_KEY });
  };
  /**
   * What the keyboard gives the focus to is seen; a tool’s floor, which is as large as the map, always is where its
   * part is. What is pressed stays where it is, under the pointer.
   */
  const follow = (event: FocusEvent<SVGSVGElement>) => {
    if (!isNearer || event.target === event.currentTarget || !event.target.matches(":focus-visible")) return;
    const pane = event.currentTarget.getBoundingClientRect();
    const { x, y, width: wide, height: high } = event.target.getBoundingClientRect();
    const next = showing(view, { x: x - pane.x, y: y - pane.y, width: wide, height: high }, pane);
    if (next !== view) put(next);
  };
  return {
    surface,
    report,
    of: fit,
    below: CONTROLS,
    view,
    isNearer,
    zoomIn: () => zoomAt(STEP),
    zoomOut: () => zoomAt(1 / STEP),
    fit: () => setOwn(null),
    /** What the map’s drawing hears and is called. */
    handlers: {
      ...(isNearer && { tabIndex: 0, role: "group", "aria-label": t("pages.map.zoom.moved") }),
      onKeyDown: pan,
      onFocus: follow,
      onPointerDownCapture: grab,
      onPointerMove: drag,
      onPointerUp: drop,
      onPointerCancel: drop,
    },
  };
}
