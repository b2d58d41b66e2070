/** A zone that an admin selects, moves as a whole by dragging or by the arrow keys, and changes at its corners. */
import type { KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import type { MapZone, SiteMap } from "@/api/types";
import { zoneWords } from "@/map/floor/zoneWords";
import { useDrag } from "../../devices/movable";
import { nudge } from "../../devices/placement";
import { pathOf, shifted } from "./outline";
import { useOutlineDraft } from "./useOutlineDraft";
import { ZoneCorners } from "./ZoneCorners";
import styles from "./zones.module.css";

interface MovableZoneProps {
  slug: string;
  map: SiteMap;
  zone: MapZone;
  isSelected: boolean;
  onSelect: () => void;
}

export function MovableZone({ slug, map, zone, isSelected, onSelect }: MovableZoneProps) {
  const { t } = useTranslation();
  const draft = useOutlineDraft(slug, zone);
  const { points } = draft;
  const press = (event: KeyboardEvent) => {
    const by = nudge([0, 0], event.key, event.shiftKey);
    if (by) draft.show(shifted(points, by, map));
    else if (event.key === "Enter") draft.keep();
    else if (event.key === "Escape") draft.show(null);
    else return;
    event.preventDefault();
  };
  const dragging = useDrag({
    at: points,
    show: (from, by) => draft.show(shifted(from, by, map)),
    keep: draft.keep,
    giveUp: () => draft.show(null),
  });
  return (
    <g>
      <path
        d={pathOf(points, true)}
        className={styles.area}
        role="button"
        tabIndex={0}
        aria-pressed={isSelected}
        aria-label={zoneWords(zone, t)}
        aria-describedby="zones-help"
        {...dragging}
        onPointerDown={(event) => {
          if (event.button === 0) onSelect();
          dragging.onPointerDown(event);
        }}
        onFocus={onSelect}
        onKeyDown={press}
        onBlur={() => draft.keep()}
      />
      {isSelected ? <ZoneCorners map={map} draft={draft} /> : null}
    </g>
  );
}
