/** The zones over the map while an admin edits them, and the floor on which a new one is drawn. */
import type { SiteMap } from "@/api/types";
import { useRemovedMeanwhile } from "../useRemovedMeanwhile";
import { MovableZone } from "./MovableZone";
import { pathOf } from "./outline";
import type { ZoneEditing } from "./useZones";
import { ZoneCorners } from "./ZoneCorners";
import { ZoneTool } from "./ZoneTool";
import styles from "./zones.module.css";

export function ZoneHandles({ slug, map, zones }: { slug: string; map: SiteMap; zones: ZoneEditing }) {
  const { drawn, draw, stop } = zones;
  useRemovedMeanwhile(zones.zone, map.zones, () => zones.select(null));
  return (
    <>
      {drawn
        ? null
        : map.zones.map((zone) => (
            <MovableZone
              key={zone.id}
              slug={slug}
              map={map}
              zone={zone}
              isSelected={zones.zone?.id === zone.id}
              onSelect={() => zones.select(zone.id)}
            />
          ))}
      {drawn && !drawn.closed ? <ZoneTool map={map} corners={drawn.corners} draw={draw} stop={stop} /> : null}
      {drawn?.closed ? <FreshZone map={map} zones={zones} /> : null}
    </>
  );
}

/** Drawn, but not yet named: nothing is sent before it is. */
function FreshZone({ map, zones }: { map: SiteMap; zones: ZoneEditing }) {
  const corners = zones.drawn?.corners ?? [];
  const set = (points?: typeof corners | null) => {
    if (points) zones.draw({ corners: points, closed: true });
  };
  return (
    <g>
      <path className={styles.fresh} d={pathOf(corners, true)} />
      <ZoneCorners map={map} draft={{ points: corners, show: set, keep: set }} />
    </g>
  );
}
