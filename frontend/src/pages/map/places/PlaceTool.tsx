/** The floor while a place is being added: a click puts it there, Enter in the middle. */
import { useEffect, useRef, type KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import type { SiteMap } from "@/api/types";
import { planBox } from "@/map/floor/floor";
import type { Point } from "@/map/plane/projection";
import { pointed } from "../../devices/movable";
import { onMap } from "../../devices/placement";
import { freeMiddle } from "./newPlace";
import styles from "./places.module.css";

export function PlaceTool({ map, put, stop }: { map: SiteMap; put: (at: Point) => void; stop: () => void }) {
  const { t } = useTranslation();
  const floor = useRef<SVGRectElement>(null);
  useEffect(() => floor.current?.focus(), []);
  const { left, top, right, bottom } = planBox(map);
  const press = (event: KeyboardEvent) => {
    if (event.key === "Enter") put(freeMiddle(map));
    else if (event.key === "Escape") stop();
    else return;
    event.preventDefault();
  };
  return (
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
  );
}
