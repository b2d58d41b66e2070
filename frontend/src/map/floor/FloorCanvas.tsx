/** The floor below everything else: one canvas that follows a viewport. */
import { useCallback, useMemo } from "react";
import { useTranslation } from "react-i18next";
import type { FloorPlan } from "./floor";
import { floorShapes, paintFloor, type FloorDetail, type Underlay } from "./floorPainter";
import classes from "../map.module.css";
import type { Palette } from "../plane/palette";
import { useZonesAt } from "./openZones";
import { zoneSign } from "./zonePainter";
import { signWords } from "./zoneWords";
import { useCanvas } from "../plane/useCanvas";
import type { ViewportSource } from "../plane/viewport";

const FULL: FloorDetail = { rulers: true, labels: true, grid: true };

export function FloorCanvas({
  plan,
  viewport,
  detail = FULL,
  under = null,
}: {
  plan: FloorPlan | null;
  viewport: ViewportSource;
  detail?: FloorDetail;
  under?: Underlay | null;
}) {
  const { t } = useTranslation();
  const zones = plan?.zones;
  const at = useZonesAt(zones);
  const signs = useMemo(() => (zones ?? []).map((zone) => zoneSign(zone, signWords(zone, t, at), at)), [zones, t, at]);
  const shapes = useMemo(() => (plan ? floorShapes(plan, signs, under) : null), [plan, signs, under]);
  const paint = useCallback(
    (canvas: CanvasRenderingContext2D, size: { width: number; height: number }, palette: Palette) =>
      paintFloor(canvas, size, palette, shapes, viewport.get(), detail),
    [shapes, viewport, detail],
  );
  const canvas = useCanvas(paint, viewport);
  return <canvas ref={canvas} className={classes.layer} aria-hidden="true" />;
}
