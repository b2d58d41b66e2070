/** The whole floor as a button while something is put on it: a click says where, Enter in the middle, Esc ends it. */
import { useEffect, useRef, type KeyboardEvent } from "react";
import type { SiteMap } from "@/api/types";
import { planBox } from "@/map/floor/floor";
import type { Point } from "@/map/plane/projection";
import { pointed } from "../devices/movable";
import { nudge, onMap } from "../devices/placement";
import { freeMiddle } from "./places/newPlace";
import styles from "./places/places.module.css";
import { usePageKey } from "./usePageKey";

interface FloorToolProps {
  map: SiteMap;
  label: string;
  /** Where it is to be so far, in metres: arrow keys move it on from there. */
  at?: Point | null;
  put: (at: Point) => void;
  stop: () => void;
}

export function FloorTool({ map, label, at = null, put, stop }: FloorToolProps) {
  const floor = useRef<SVGRectElement>(null);
  useEffect(() => floor.current?.focus({ preventScroll: true }), []);
  usePageKey("Escape", stop); // also after a click beside the floor
  const { left, top, right, bottom } = planBox(map);
  const press = (event: KeyboardEvent) => {
    const moved = at && nudge(at, event.key, event.shiftKey);
    if (moved) put(onMap(moved, map));
    else if (event.key === "Enter") put(at ?? freeMiddle(map));
    else return;
    event.preventDefault();
  };
  return (
    <rect
      ref={floor}
      className={styles.floor}
      role="button"
      tabIndex={0}
      aria-label={label}
      x={left}
      y={top}
      width={right - left}
      height={bottom - top}
      onClick={(event) => put(onMap(pointed(event), map))}
      onKeyDown={press}
    />
  );
}
