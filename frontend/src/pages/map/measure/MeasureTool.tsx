/** The floor while somebody measures: two clicks or a drag, or a cross-hair by keys; what is measured is over it. */
import { use, useEffect, useMemo, useRef, type KeyboardEvent, type PointerEvent } from "react";
import { useTranslation } from "react-i18next";
import type { SiteMap } from "@/api/types";
import { useFocusAfter } from "@/design/useReturnFocus";
import { knownBox, planBox } from "@/map/floor/floor";
import type { Point } from "@/map/plane/projection";
import { ZoomContext } from "@/map/plane/zoom";
import { pointed } from "../../devices/movable";
import { isSame, nudge, onMap } from "../../devices/placement";
import { CrossHair, End, MeasuredLine } from "./marks";
import styles from "./measure.module.css";
import { MEASURE_BUTTON } from "./MeasureButton";
import { lineOf } from "./measuring";
import { reachAt } from "./snapping";
import type { MeasureView } from "./useMeasuring";
import { usePageKey } from "../usePageKey";

/** How far (m) an arrow key moves the cross-hair, and with Shift. */
const STEPS = [0.05, 0.5] as const;

interface MeasureToolProps {
  map: SiteMap;
  view: MeasureView;
  stop: () => void;
}

export function MeasureTool({ map, view, stop }: MeasureToolProps) {
  const { t } = useTranslation();
  const zoom = use(ZoomContext);
  const floor = useRef<SVGRectElement>(null);
  useEffect(() => floor.current?.focus({ preventScroll: true }), []);
  useFocusAfter(() => document.getElementById(MEASURE_BUTTON));
  usePageKey("Escape", () => {
    if (!view.clear()) stop();
  });
  const press = (event: KeyboardEvent) => {
    const moved = nudge(view.cross(), event.key, event.shiftKey, STEPS);
    if (moved) view.step(onMap(moved, map));
    else if (event.key === "Enter" || event.key === " ") view.put();
    else return;
    event.preventDefault();
  };
  const { left, top, right, bottom } = planBox(map);
  return (
    <g>
      <rect
        ref={floor}
        className={styles.floor}
        role="application"
        tabIndex={0}
        aria-label={t("measure.floor")}
        aria-describedby="measure-help"
        x={left}
        y={top}
        width={right - left}
        height={bottom - top}
        onKeyDown={press}
        {...usePointer(map, view, reachAt(zoom))}
      />
      <Measured map={map} view={view} zoom={zoom} />
    </g>
  );
}

function usePointer(map: SiteMap, view: MeasureView, reach: number) {
  const last = useRef<Point | null>(null);
  const at = (event: PointerEvent<SVGRectElement>) => onMap(pointed(event), map);
  return {
    onPointerDown: (event: PointerEvent<SVGRectElement>) => {
      if (!event.isPrimary) return view.cancel(); // a second finger gives up what the first one began
      if (event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      view.press(at(event), reach);
    },
    onPointerMove: (event: PointerEvent<SVGRectElement>) => {
      const now = at(event);
      // A pointer that rests is told of, too, when what is below it changes: the keys go on.
      if (!event.isPrimary || (last.current && isSame(last.current, now))) return;
      last.current = now;
      view.aim(now, reach);
    },
    onPointerUp: (event: PointerEvent<SVGRectElement>) => {
      if (event.isPrimary) view.release(at(event), reach);
    },
    onPointerLeave: () => {
      last.current = null;
      view.leave();
    },
    onPointerCancel: view.cancel,
  };
}

interface MeasuredProps {
  map: SiteMap;
  view: MeasureView;
  zoom: number;
}

function Measured({ map, view: { measuring }, zoom }: MeasuredProps) {
  const frame = useMemo(() => knownBox(map), [map]);
  const line = lineOf(measuring);
  const { ends, aim, cross } = measuring;
  return (
    <g aria-hidden="true">
      {line ? <MeasuredLine line={line} zoom={zoom} frame={frame} /> : null}
      {line ? null : ends.map((end, index) => <End key={index} at={end} zoom={zoom} />)}
      {aim ? <End at={aim} zoom={zoom} /> : null}
      {cross ? <CrossHair at={cross} zoom={zoom} /> : null}
    </g>
  );
}
