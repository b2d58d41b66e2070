/** A machine that an admin puts somewhere else on the map, by dragging or by the arrow keys. */
import { useTranslation } from "react-i18next";
import type { Device, Site, SiteMap } from "@/api/types";
import { formatNumber } from "@/i18n/format";
import { footprint } from "@/map/devices/device";
import { nameOnMap } from "@/map/devices/framing";
import { DeviceGlyph } from "@/map/devices/DeviceToken";
import { toPixels } from "@/map/plane/projection";
import { useDecide } from "./decisions";
import { movedByKey, useDraftPoint, useDragging } from "./movable";
import styles from "./keys/keys.module.css";

const HALO = 5;

interface MovableProps {
  site: Site;
  map: SiteMap;
  device: Device;
}

export function MovableMachine({ site, map, device }: MovableProps) {
  const { t } = useTranslation();
  const decide = useDecide(site.slug);
  const { x, y } = device.location;
  const place = useDraftPoint(map, [x, y], decide.isPending, (to, done) =>
    decide.mutate({ do: "move", device, to }, done),
  );
  const { at, draft, keep } = place;
  const pixel = toPixels(at);
  const { width, height } = footprint(device);
  return (
    <g
      transform={`translate(${pixel.x} ${pixel.y})`}
      className={styles.movable}
      role="button"
      tabIndex={0}
      aria-label={t("placing.at", { name: device.name, x: formatNumber(at[0], 2), y: formatNumber(at[1], 2) })}
      aria-describedby="placing-help"
      data-moved={draft ? true : undefined}
      {...useDragging(place)}
      onKeyDown={(event) => movedByKey(event, place)}
      onBlur={keep}
    >
      <DeviceGlyph device={device} plain />
      <rect
        className={styles.halo}
        x={-width / 2 - HALO}
        y={-height / 2 - HALO}
        width={width + 2 * HALO}
        height={height + 2 * HALO}
        rx={8}
      />
      <text className={styles.movableName} y={height / 2 + 22} textAnchor="middle">
        {nameOnMap(device.name)}
      </text>
    </g>
  );
}
