/** The map that is being changed: floor, machines and places over it, and the stroke in hand. */
import { useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import type { Device, SiteMap } from "@/api/types";
import { formatPoint } from "@/i18n/format";
import { DeviceGlyph } from "@/map/devices/DeviceToken";
import { FloorCanvas } from "@/map/floor/FloorCanvas";
import { planBox } from "@/map/floor/floor";
import type { CellMap } from "@/map/floor/rosFiles";
import { toPixels, type Point } from "@/map/plane/projection";
import { useSize } from "@/map/plane/useSize";
import { useWheelZoom } from "@/map/plane/useWheelZoom";
import { CrossHair } from "../map/measure/marks";
import styles from "./mapEdit.module.css";
import { StrokeShape } from "./StrokeShape";
import { ToolRail } from "./ToolRail";
import type { Settings } from "./tools";
import { useMapView } from "./useMapView";
import { useStroke } from "./useStroke";

interface SurfaceProps {
  site: SiteMap;
  map: CellMap;
  devices: readonly Device[];
  settings: Settings;
  choose: (tool: Settings["tool"]) => void;
  finish: (stroke: readonly Point[]) => void;
  measured: readonly Point[];
}

export function EditSurface({ site, map, devices, settings, choose, finish, measured }: SurfaceProps) {
  const { t } = useTranslation();
  const [pane, { width, height }] = useSize<HTMLDivElement>();
  const plan = useMemo(() => ({ ...map, version: site.version, places: site.places }), [map, site]);
  const view = useMapView(plan, width, height);
  const { stroke, cursor, press, pointer } = useStroke({ map, view, settings, finish });
  const surface = useRef<SVGSVGElement>(null);
  useWheelZoom(surface, (factor, x, y) => {
    view.zoomAt(factor, x, y);
    return true;
  });
  const { x, y, zoom } = view.view;
  const shown = stroke.length > 0 ? stroke : settings.tool === "measure" ? measured : [];
  return (
    <div ref={pane} className={styles.pane}>
      <FloorCanvas plan={plan} viewport={view.cell} />
      {/* oxlint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- an application takes keys */}
      <svg
        ref={surface}
        className={styles.surface}
        data-tool={settings.tool}
        role="application"
        // oxlint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- an application takes keys
        tabIndex={0}
        aria-label={t("mapEdit.surface", { tool: t(`mapEdit.tool.${settings.tool}`) })}
        aria-describedby="map-edit-keys"
        onKeyDown={press}
        {...pointer}
      >
        <g transform={`translate(${String(x)} ${String(y)}) scale(${String(zoom)})`}>
          <Frame map={plan} />
          {devices.map((device) => {
            const at = toPixels([device.location.x, device.location.y]);
            return (
              <g key={device.id} transform={`translate(${String(at.x)} ${String(at.y)})`} className={styles.device}>
                <DeviceGlyph device={device} plain />
              </g>
            );
          })}
          {site.places.map((place) => (
            <circle key={place.id} {...centre([place.x, place.y])} r={7 / zoom} className={styles.place} />
          ))}
          <StrokeShape stroke={shown} settings={settings} zoom={zoom} />
          {cursor ? <CrossHair at={cursor} zoom={zoom} /> : null}
        </g>
      </svg>
      <ToolRail tool={settings.tool} choose={choose} view={view} />
      <p className="visually-hidden" id="map-edit-keys">
        {t("mapEdit.keys")}
      </p>
      <p className={styles.where} aria-live="polite">
        {cursor ? formatPoint(...cursor) : ""}
      </p>
    </div>
  );
}

function centre(point: Point) {
  const { x, y } = toPixels(point);
  return { cx: x, cy: y };
}

function Frame({ map }: { map: Parameters<typeof planBox>[0] }) {
  const { left, top, right, bottom } = planBox(map);
  return <rect className={styles.frame} x={left} y={top} width={right - left} height={bottom - top} />;
}
