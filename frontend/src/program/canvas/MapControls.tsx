/** Bottom right of the map: the floor in small, zoom, fit, a scale. */
import { Maximize, Minus, Plus } from "lucide-react";
import { useEffect, useMemo, useState } from "react";
import type { FloorPlan } from "@/map/floor/floor";
import { MiniMap } from "@/map/floor/MiniMap";
import { PIXELS_PER_METRE, type Insets } from "@/map/plane/projection";
import type { Scene } from "../scene/scene";
import classes from "./controls.module.css";
import { useStage } from "./stageContext";
import { useEditorText } from "./useScene";

export function MapControls({
  plan,
  scene,
  insets,
  mini = false,
}: {
  plan: FloorPlan | null;
  scene: Scene;
  insets: Insets;
  mini?: boolean;
}) {
  const t = useEditorText();
  const { viewport, pane, fit, flow } = useStage();
  // Steps that drive the same way share one line.
  const lines = useMemo(() => [...new Set(scene.routes.map((route) => route.points))], [scene]);
  return (
    <div className={classes.controls} style={{ right: insets.right, bottom: insets.bottom }}>
      {mini ? (
        <div className={classes.mini}>
          <MiniMap
            plan={plan}
            viewport={viewport}
            pane={pane}
            label={t("controls.minimap")}
            onGo={(point) => void flow.setCenter(point.x, point.y, { zoom: viewport.get().zoom })}
            lines={lines}
          />
        </div>
      ) : null}
      <div className={classes.row}>
        <button type="button" aria-label={t("controls.zoom_out")} onClick={() => void flow.zoomOut({ duration: 180 })}>
          <Minus size={15} aria-hidden="true" />
        </button>
        <ZoomValue />
        <button type="button" aria-label={t("controls.zoom_in")} onClick={() => void flow.zoomIn({ duration: 180 })}>
          <Plus size={15} aria-hidden="true" />
        </button>
        <button type="button" aria-label={t("controls.fit")} onClick={fit}>
          <Maximize size={15} aria-hidden="true" />
        </button>
        {mini ? <Scale /> : null}
      </div>
    </div>
  );
}

function useZoom(): number {
  const { viewport } = useStage();
  const [zoom, setZoom] = useState(() => viewport.get().zoom);
  useEffect(() => viewport.subscribe(() => setZoom(viewport.get().zoom)), [viewport]);
  return zoom;
}

function ZoomValue() {
  const zoom = useZoom();
  return <span className={classes.value}>{`${Math.round(zoom * 100)}\u202f%`}</span>;
}

/** A bar of 1, 2, 5 or 10 m, whichever is nearest to 40 px. */
function Scale() {
  const perMetre = useZoom() * PIXELS_PER_METRE;
  const metres = [1, 2, 5, 10].find((each) => each * perMetre >= 28) ?? 10;
  return (
    <span className={classes.scale} aria-hidden="true">
      {`${metres}\u202fm`}
      <span style={{ width: Math.min(64, metres * perMetre) }} />
    </span>
  );
}
