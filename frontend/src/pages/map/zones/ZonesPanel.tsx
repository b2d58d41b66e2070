/** The zones of a map as a list; admins draw, change and remove them here. */
import { Button } from "@mantine/core";
import { SquareDashed, X } from "lucide-react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { useFloorCheck } from "@/api/floorCheck";
import { useFloorUse } from "@/api/floorUse";
import { useDevices } from "@/api/queries";
import type { FloorCheck, FloorUse, MapZone, SiteMap, ZoneCost } from "@/api/types";
import { useZoneCosts } from "@/api/zones";
import { Chip } from "@/design/Chip";
import { formatNumber, withUnit } from "@/i18n/format";
import { useZonesAt } from "@/map/floor/openZones";
import { ruleWords } from "@/map/floor/zoneWords";
import styles from "../places/places.module.css";
import own from "./zones.module.css";
import { areaOf } from "./outline";
import { ReleasedZone } from "./ReleasedZone";
import { ZoneCosts } from "./ZoneCosts";
import { RemoveZone } from "./RemoveZone";
import type { ZoneEditing } from "./useZones";
import { NewZoneForm, ZoneForm } from "./ZoneForms";

interface ZonesPanelProps {
  slug: string;
  map: SiteMap;
  /** Null for who only looks. */
  editing: ZoneEditing | null;
}

export function ZonesPanel({ slug, map, editing }: ZonesPanelProps) {
  const { t } = useTranslation();
  const at = useZonesAt(map.zones);
  const [removing, setRemoving] = useState<MapZone | null>(null);
  const isThere = map.zones.some(({ id }) => id === removing?.id);
  useEffect(() => {
    if (!isThere) setRemoving(null); // whoever has removed it
  }, [isThere]);
  const costs = useZoneCosts(slug, map.zones).data ?? [];
  const widths =
    useFloorCheck(slug, map, useDevices(slug).data ?? [], { enabled: costs.length > 0 && !editing }).data?.zones ?? [];
  const uses = useFloorUse(slug, { enabled: costs.length > 0 }).data?.zones ?? [];
  return (
    <section aria-labelledby="zones">
      <h2 id="zones">{t("zone.zones")}</h2>
      {editing ? <Adding editing={editing} /> : null}
      {map.zones.length === 0 ? <p className={styles.quiet}>{t("zone.none")}</p> : null}
      <ul className={styles.list}>
        {map.zones.map((zone) => (
          <li key={zone.id}>
            <Row zone={zone} at={at} editing={editing} />
            {zone.rule === "release" ? <ReleasedZone slug={slug} zone={zone} at={at} /> : null}
            <CostOf zone={zone} costs={costs} widths={widths} uses={uses} />
            {editing?.zone?.id === zone.id ? (
              <ZoneForm slug={slug} map={map} zone={zone} remove={() => setRemoving(zone)} />
            ) : null}
          </li>
        ))}
      </ul>
      {editing && removing && isThere ? (
        <RemoveZone slug={slug} map={map} zone={removing} select={editing.select} onClose={() => setRemoving(null)} />
      ) : null}
    </section>
  );
}

interface CostOfProps {
  zone: MapZone;
  costs: readonly ZoneCost[];
  widths: FloorCheck["zones"];
  uses: FloorUse["zones"];
}

function CostOf({ zone, costs, widths, uses }: CostOfProps) {
  const isOf = (each: { zone: string }) => each.zone === zone.id;
  const cost = costs.find(isOf);
  return cost ? <ZoneCosts cost={cost} width={widths.find(isOf)} use={uses.find(isOf)} /> : null;
}

function Adding({ editing }: { editing: ZoneEditing }) {
  const { t } = useTranslation();
  const { drawn, begin, stop } = editing;
  const Icon = drawn ? X : SquareDashed;
  return (
    <div className={styles.adding}>
      <p id="zones-help" className={styles.quiet}>
        {t(drawn && !drawn.closed ? "zone.drawHelp" : "zone.help")}
      </p>
      {drawn?.closed ? <NewZoneForm editing={editing} /> : null}
      <Button
        variant={drawn ? "default" : "light"}
        leftSection={<Icon size={16} aria-hidden="true" />}
        onClick={drawn ? stop : begin}
      >
        {t(drawn ? "zone.addStop" : "zone.add")}
      </Button>
    </div>
  );
}

function Row({ zone, at, editing }: { zone: MapZone; at: number; editing: ZoneEditing | null }) {
  const { t } = useTranslation();
  const words = (
    <>
      <span>{zone.name}</span>
      <Chip>{ruleWords(zone, t, at)}</Chip>
      <code>{withUnit(formatNumber(areaOf(zone.points), 1), "m²")}</code>
    </>
  );
  if (!editing) return <div className={`${styles.row} ${own.row}`}>{words}</div>;
  const isOpen = editing.zone?.id === zone.id;
  return (
    <button
      type="button"
      className={`${styles.row} ${own.row}`}
      aria-expanded={isOpen}
      onClick={() => editing.select(isOpen ? null : zone.id)}
    >
      {words}
    </button>
  );
}
