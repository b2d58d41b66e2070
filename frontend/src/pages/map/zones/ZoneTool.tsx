/** The floor while a zone is drawn: a drag makes a rectangle, clicks make corners, Enter a square or the last corner. */
import { useEffect, useRef, useState, type KeyboardEvent, type PointerEvent } from "react";
import { useTranslation } from "react-i18next";
import type { SiteMap } from "@/api/types";
import { planBox } from "@/map/floor/floor";
import { toPixels, type Point } from "@/map/plane/projection";
import { pointed } from "../../devices/movable";
import { onMap } from "../../devices/placement";
import { freeMiddle } from "../places/newPlace";
import { usePageKey } from "../usePageKey";
import { CLICK_M, CLOSES_M, FEWEST_CORNERS, isNear, pathOf, rectangle, squareAt, type Outline } from "./outline";
import type { Drawn } from "./useZones";
import styles from "./zones.module.css";

interface ZoneToolProps {
  map: SiteMap;
  corners: Outline;
  draw: (drawn: Drawn) => void;
  stop: () => void;
}

export function ZoneTool({ map, corners, draw, stop }: ZoneToolProps) {
  const { t } = useTranslation();
  const floor = useRef<SVGRectElement>(null);
  useEffect(() => floor.current?.focus({ preventScroll: true }), []);
  usePageKey("Escape", stop); // also after a click beside the floor
  const [from, setFrom] = useState<Point | null>(null);
  const [to, setTo] = useState<Point | null>(null);
  const press = (event: KeyboardEvent) => {
    if (event.key === "Enter" && corners.length === 0) draw({ corners: squareAt(freeMiddle(map), map), closed: true });
    else if (event.key === "Enter" && corners.length >= FEWEST_CORNERS) draw({ corners, closed: true });
    else if (event.key === "Backspace" && corners.length > 0) draw({ corners: corners.slice(0, -1), closed: false });
    else return;
    event.preventDefault();
  };
  const click = (at: Point) => {
    const first = corners[0];
    const closes = first && corners.length >= FEWEST_CORNERS && isNear(first, at, CLOSES_M);
    draw(closes ? { corners, closed: true } : { corners: [...corners, at], closed: false });
  };
  const release = (event: PointerEvent<SVGRectElement>) => {
    const at = onMap(pointed(event), map);
    setFrom(null);
    setTo(null);
    if (!from) return;
    const [across, along] = [Math.abs(at[0] - from[0]), Math.abs(at[1] - from[1])];
    if (Math.max(across, along) < CLICK_M) click(at);
    else if (Math.min(across, along) >= CLICK_M) draw({ corners: rectangle(from, at), closed: true });
  };
  const { left, top, right, bottom } = planBox(map);
  const shown = from && to ? rectangle(from, to) : corners;
  return (
    <g>
      {shown.length > 0 ? <path className={styles.fresh} d={pathOf(shown, shown !== corners)} /> : null}
      {corners.map(toPixels).map(({ x, y }, at) => (
        <circle key={at} className={styles.set} cx={x} cy={y} r={at === 0 ? 7 : 5} />
      ))}
      <rect
        ref={floor}
        className={styles.floor}
        role="button"
        tabIndex={0}
        aria-label={t("zone.draw")}
        x={left}
        y={top}
        width={right - left}
        height={bottom - top}
        onPointerDown={(event) => {
          if (event.button !== 0) return;
          event.currentTarget.setPointerCapture(event.pointerId);
          setFrom(onMap(pointed(event), map));
        }}
        onPointerMove={(event) => {
          if (from) setTo(onMap(pointed(event), map));
        }}
        onPointerUp={release}
        onPointerCancel={() => (setFrom(null), setTo(null))}
        onKeyDown={press}
      />
    </g>
  );
}
