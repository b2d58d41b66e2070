/** A named place that an admin selects and puts somewhere else, by dragging or by the arrow keys. */
import { MapPin, SquareParking, TextCursorInput } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useChangePlace, type PlaceKind } from "@/api/places";
import type { MapPlace, SiteMap } from "@/api/types";
import { formatNumber } from "@/i18n/format";
import { toPixels } from "@/map/plane/projection";
import { ownEntry } from "@/design/ownEntry";
import { movedByKey, useDraftPoint, useDragging } from "../../devices/movable";
import { tellRefusal } from "@/shell/refusal";
import styles from "./places.module.css";

const ICONS: Readonly<Record<PlaceKind, typeof MapPin>> = { point: MapPin, dock: SquareParking, room: TextCursorInput };
const HALF = 13;

interface MovablePlaceProps {
  slug: string;
  map: SiteMap;
  place: MapPlace;
  isSelected: boolean;
  onSelect: () => void;
}

export function MovablePlace({ slug, map, place, isSelected, onSelect }: MovablePlaceProps) {
  const { t } = useTranslation();
  const change = useChangePlace(slug, (error) => tellRefusal(error, t));
  const draft = useDraftPoint(map, [place.x, place.y], change.isPending, ([x, y], done) =>
    change.mutate({ do: "edit", id: place.id, fields: { x, y } }, done),
  );
  const { at, keep } = draft;
  const pixel = toPixels(at);
  const dragging = useDragging(draft);
  const Icon = ownEntry(ICONS, place.kind) ?? MapPin;
  return (
    <g
      transform={`translate(${pixel.x} ${pixel.y})`}
      className={styles.handle}
      role="button"
      tabIndex={0}
      aria-pressed={isSelected}
      aria-label={t("placing.at", { name: place.name, x: formatNumber(at[0], 2), y: formatNumber(at[1], 2) })}
      aria-describedby="places-help"
      {...dragging}
      onPointerDown={(event) => {
        onSelect();
        dragging.onPointerDown(event);
      }}
      onFocus={onSelect}
      onKeyDown={(event) => movedByKey(event, draft)}
      onBlur={keep}
    >
      <rect className={styles.reach} x={-24} y={-24} width={48} height={48} />
      {place.kind === "dock" ? <rect className={styles.dock} x={-20} y={-25} width={40} height={50} rx={6} /> : null}
      <rect className={styles.token} x={-HALF} y={-HALF} width={2 * HALF} height={2 * HALF} rx={7} />
      <Icon x={-8} y={-8} width={16} height={16} aria-hidden="true" />
      <text className={styles.name} y={place.kind === "dock" ? 40 : 30} textAnchor="middle">
        {place.name}
      </text>
    </g>
  );
}
