/** The floor while a place is being added: a click puts it there, Enter in the middle; arrow keys move it on. */
import { MapPin } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { SiteMap } from "@/api/types";
import { toPixels, type Point } from "@/map/plane/projection";
import { FloorTool } from "../FloorTool";
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
  const pixel = at && toPixels(at);
  return (
    <>
      {pixel ? (
        <g transform={`translate(${String(pixel.x)} ${String(pixel.y)})`} className={styles.fresh}>
          <rect className={styles.token} x={-13} y={-13} width={26} height={26} rx={7} />
          <MapPin x={-8} y={-8} width={16} height={16} aria-hidden="true" />
        </g>
      ) : null}
      <FloorTool map={map} label={t("place.put")} at={at} put={put} stop={stop} />
    </>
  );
}
