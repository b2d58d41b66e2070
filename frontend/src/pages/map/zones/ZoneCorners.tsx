/** The corners of an outline: dragged, moved by arrow keys, added on the middle of a side, taken away with Delete. */
import type { KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import { formatNumber } from "@/i18n/format";
import { toPixels, type Point } from "@/map/plane/projection";
import { useDrag } from "../../devices/movable";
import { nudge, onMap, type Extent } from "../../devices/placement";
import { middleOf, withCorner, withMoved, withoutCorner, type Outline } from "./outline";
import type { OutlineDraft } from "./useOutlineDraft";
import styles from "./zones.module.css";

interface ZoneCornersProps {
  map: Extent;
  draft: OutlineDraft;
}

export function ZoneCorners({ map, draft }: ZoneCornersProps) {
  const { t } = useTranslation();
  const { points } = draft;
  return (
    <>
      {points.map((_, at) => {
        const { x, y } = toPixels(middleOf(points, at));
        const add = () => draft.keep(withCorner(points, at + 1, middleOf(points, at)));
        return (
          <circle
            key={at}
            className={styles.between}
            cx={x}
            cy={y}
            r={6}
            role="button"
            tabIndex={0}
            aria-label={t("zone.newCorner", { number: at + 1 })}
            onClick={add}
            onKeyDown={(event) => {
              if (event.key !== "Enter" && event.key !== " ") return;
              event.preventDefault();
              add();
            }}
          />
        );
      })}
      {points.map((corner, at) => (
        <Corner key={at} at={at} corner={corner} points={points} map={map} draft={draft} />
      ))}
    </>
  );
}

interface CornerProps extends ZoneCornersProps {
  at: number;
  corner: Point;
  points: Outline;
}

function Corner({ at, corner, points, map, draft }: CornerProps) {
  const { t } = useTranslation();
  const move = (to: Point) => draft.show(withMoved(points, at, onMap(to, map)));
  const press = (event: KeyboardEvent) => {
    const moved = nudge(corner, event.key, event.shiftKey);
    if (moved) move(moved);
    else if (event.key === "Enter") draft.keep();
    else if (event.key === "Escape") draft.show(null);
    else if (event.key === "Delete" || event.key === "Backspace") draft.keep(withoutCorner(points, at));
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const dragging = useDrag({
    at: corner,
    show: (from, by) => move([from[0] + by[0], from[1] + by[1]]),
    keep: draft.keep,
    giveUp: () => draft.show(null),
  });
  const { x, y } = toPixels(corner);
  const [cornerX, cornerY] = corner;
  const name = t("zone.corner", { number: at + 1, x: formatNumber(cornerX, 2), y: formatNumber(cornerY, 2) });
  return (
    <>
      <rect className={styles.corner} x={x - 6.5} y={y - 6.5} width={13} height={13} rx={3} />
      <rect
        className={styles.reach}
        x={x - 20}
        y={y - 20}
        width={40}
        height={40}
        rx={6}
        role="button"
        tabIndex={0}
        aria-label={name}
        aria-describedby="zones-help"
        {...dragging}
        onKeyDown={press}
        onBlur={() => draft.keep()}
      />
    </>
  );
}
