/** The map that a picture becomes, with the line that is measured on it. */
import { useDeferredValue, useEffect, useRef } from "react";
import { useTranslation } from "react-i18next";
import { useSize } from "@/map/plane/useSize";
import { MeasuredLine } from "./MeasuredLine";
import { paintCells } from "./paintCells";
import { mapFromPicture, type Picture, type PlanReading } from "./picture";
import styles from "./plan.module.css";

/** In the preview a cell is a pixel, however large that is. */
const PIXEL_BY_PIXEL = { line: [[0, 0], [20, 0]], length: 1 } as const; // prettier-ignore

function paint(canvas: HTMLCanvasElement, picture: Picture, reading: PlanReading): void {
  const map = mapFromPicture(picture, { ...reading, ...PIXEL_BY_PIXEL });
  if (map) paintCells(canvas, map);
}

interface PreviewProps {
  picture: Picture;
  reading: PlanReading;
  change: (line: PlanReading["line"]) => void;
}

export function PlanPreview({ picture, reading, change }: PreviewProps) {
  const { t } = useTranslation();
  const canvas = useRef<HTMLCanvasElement>(null);
  const [element, { width }] = useSize<HTMLDivElement>();
  const threshold = useDeferredValue(reading.threshold);
  const { outsideUnknown } = reading;
  useEffect(() => {
    if (canvas.current)
      paint(canvas.current, picture, { threshold, outsideUnknown, line: PIXEL_BY_PIXEL.line, length: 1 });
  }, [picture, threshold, outsideUnknown]);
  const ratio = picture.width / picture.height;
  return (
    <div ref={element} className={styles.preview} style={{ aspectRatio: ratio, maxWidth: `${String(68 * ratio)}vh` }}>
      <canvas ref={canvas} role="img" aria-label={t("pages.newSite.preview")} />
      <MeasuredLine picture={picture} line={reading.line} scale={width ? picture.width / width : 1} change={change} />
    </div>
  );
}
