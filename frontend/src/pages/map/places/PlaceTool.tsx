/** The floor while a place is being added: a click puts it there, Enter in the middle; arrow keys move it on. */
import { MapPin } from "lucide-react";
import { useEffect, useRef, type KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import type { SiteMap } from "@/api/types";
import { planBox } from "@/map/floor/floor";
import { toPixels, type Point } from "@/map/plane/projection";
import { pointed } from "../../devices/movable";
import { nudge, onMap } from "../../devices/placement";
import { freeMiddle } from "./newPlace";
import styles from "./places.module.css";

interface PlaceToolProps {
  map: SiteMap;
  /** Where the new place is to be, in metres; null until somebody says where. */
  at: Point | null;
  put: (at: Point) => void;
  stop: () => void;
}

export function PlaceTool({ map, at, put, stop }: PlaceToolProps) {
  const { t } = useTranslation();
  const floor = useRef<SVGRectElement>(null);
  useEffect(() => floor.current?.focus(), []);
  const { left, top, right, bottom } = planBox(map);
  const press = (event: KeyboardEvent) => {
    const moved = at && nudge(at, event.key, event.shiftKey);
    if (moved) put(onMap(moved, map));
    else if (event.key === "Enter") put(at ?? freeMiddle(map));
    else if (event.key === "Escape") stop();
    else return;
    event.preventDefault();
  };
  const pixel = at && toPixels(at);
  return (
    <>
      {pixel ? (
        <g transform={`translate(${String(pixel.x)} ${String(pixel.y)})`} className={styles.fresh}>
          <rect className={styles.token} x={-13} y={-13} width={26} height={26} rx={7} />
          <MapPin x={-8} y={-8} width={16} height={16} aria-hidden="true" />
        </g>
      ) : null}
      <rect
        ref={floor}
        className={styles.floor}
        role="button"
        tabIndex={0}
        aria-label={t("place.put")}
        x={left}
        y={top}
        width={right - left}
        height={bottom - top}
        onClick={(event) => put(onMap(pointed(event), map))}
        onKeyDown={press}
      />
    </>
  );
}
