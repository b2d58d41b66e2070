/** Drawing on the map by mouse, pen, finger and keys: one stroke at a time, and a cross-hair for the keys. */
import { useState, type KeyboardEvent, type PointerEvent } from "react";
import type { CellMap } from "@/map/floor/rosFiles";
import type { Point } from "@/map/plane/projection";
import { strokeOn, TOOLS, type Settings, type Tool } from "./tools";
import type { MapView } from "./useMapView";

const ARROWS: Readonly<Record<string, Point>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const FAST = 10;

interface StrokeArgs {
  map: CellMap;
  view: MapView;
  settings: Settings;
  finish: (stroke: readonly Point[]) => void;
}

export function useStroke({ map, view, settings, finish }: StrokeArgs) {
  const tool = TOOLS.find(({ name }) => name === settings.tool) as Tool;
  const [stroke, setStroke] = useState<readonly Point[]>([]);
  const [cursor, setCursor] = useState<Point | null>(null);
  const [panning, setPanning] = useState<number | null>(null);
  const placeOf = (event: PointerEvent<Element>): Point => {
    const box = event.currentTarget.getBoundingClientRect();
    return view.pointAt(event.clientX - box.left, event.clientY - box.top);
  };
  const end = () => {
    if (stroke.length > 0) finish(stroke);
    setStroke([]);
  };
  const middle: Point = [
    map.origin.x + (map.width * map.resolution_m) / 2,
    map.origin.y + (map.height * map.resolution_m) / 2,
  ];
  const press = (event: KeyboardEvent) => {
    const arrow = ARROWS[event.key];
    const at = cursor ?? middle;
    if (arrow) {
      const step = map.resolution_m * (event.shiftKey ? FAST : 1);
      const next: Point = [at[0] + arrow[0] * step, at[1] + arrow[1] * step];
      setCursor(next);
      if (stroke.length > 0) setStroke(strokeOn(tool, stroke, next, false));
    } else if (event.key === "Enter" && tool.name !== "pan") {
      setCursor(at);
      if (stroke.length > 0) end();
      else setStroke([at]);
    } else if (event.key === "Escape" && stroke.length > 0) setStroke([]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return {
    stroke,
    cursor,
    press,
    pointer: {
      onPointerDown: (event: PointerEvent<Element>) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        setCursor(null);
        if (event.button === 1 || tool.name === "pan") setPanning(event.pointerId);
        else if (event.button === 0 && event.isPrimary) setStroke([placeOf(event)]);
        else setStroke([]); // a second finger gives up what the first one began
      },
      onPointerMove: (event: PointerEvent<Element>) => {
        if (panning === event.pointerId) view.panBy(event.movementX, event.movementY);
        else if (stroke.length > 0 && event.isPrimary)
          setStroke(strokeOn(tool, stroke, placeOf(event), event.shiftKey));
      },
      onPointerUp: () => {
        if (panning === null) end();
        setPanning(null);
      },
      onPointerCancel: () => {
        setStroke([]);
        setPanning(null);
      },
    },
  };
}
