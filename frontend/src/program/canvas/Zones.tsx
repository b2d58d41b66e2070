/** Zones on the map: hatched, with their name and rule. */
import { VipoIcon } from "@/design/VipoIcon";
import type { PixelPoint } from "@/map/plane/paths";
import { boxAround, toPixels } from "@/map/plane/projection";
import type { ProgramDocument, Zone } from "../document/document";
import type { Translate } from "../words/stepWords";
import stage from "./stage.module.css";
import classes from "./zones.module.css";

export const FEWEST_CORNERS = 3;

interface ZonesProps {
  document: ProgramDocument;
  t: Translate;
  selected?: string | null;
  onSelect?: (zone: string) => void;
}

/** Under everything that is drawn. */
export function Zones({ document, t, selected = null, onSelect }: ZonesProps) {
  return (
    <svg className={stage.drawing} width={1} height={1}>
      <defs>
        <pattern id="zone-hatch" width={11} height={11} patternUnits="userSpaceOnUse" patternTransform="rotate(45)">
          <line x1={0} y1={0} x2={0} y2={11} className={classes.hatch} />
        </pattern>
      </defs>
      {soundZones(document).map(([id, zone]) => (
        <ZoneShape key={id} zone={zone} selected={selected === id} t={t} onSelect={onSelect && (() => onSelect(id))} />
      ))}
    </svg>
  );
}

function ZoneShape(props: { zone: Zone; selected: boolean; t: Translate; onSelect?: () => void }) {
  const { zone, selected, t, onSelect } = props;
  const outline = `M${zone.points.map(toPixels).map(placed).join("L")}Z`;
  const box = boxAround(zone.points.map(toPixels));
  const words = zoneWords(zone, t);
  return (
    <g
      className={classes.zone}
      data-rule={zone.rule}
      data-selected={selected || undefined}
      data-pressable={onSelect ? true : undefined}
    >
      <path d={outline} className={classes.area} />
      <path d={outline} className={classes.edge} onClick={onSelect} />
      {box ? (
        <foreignObject className={classes.words} x={box.left + 6} y={box.bottom - 28} width={60} height={24}>
          <button type="button" className={classes.tag} onClick={onSelect} tabIndex={onSelect ? 0 : -1}>
            <VipoIcon name={zoneIcon(zone)} size={13} />
            <span>{words}</span>
          </button>
        </foreignObject>
      ) : null}
    </g>
  );
}

/** A passage bears the sign of a door, and no more words than its name: it is as narrow as its doorway. */
export function zoneIcon(zone: Zone): string {
  return zone.rule === "door" ? "door" : "zone";
}

export function zoneWords(zone: Zone, t: Translate): string {
  const name = String(zone.name ?? "");
  if (zone.rule === "keep_out") return t("gesture.zone.say_keep_out", { name });
  if (zone.rule === "one_at_a_time") return t("gesture.zone.say_one_at_a_time", { name });
  if (zone.rule === "door") return name;
  return t("gesture.zone.say_slow", { name, speed: `${zone.speed_m_s ?? "?"}\u202fm/s` });
}

export function placed({ x, y }: PixelPoint): string {
  return `${x} ${y}`;
}

/** The zones that can be drawn; other people may have written anything. */
export function soundZones(document: ProgramDocument): readonly (readonly [string, Zone])[] {
  return Object.entries(document.zones).filter(
    ([, zone]) => Array.isArray(zone?.points) && zone.points.length >= FEWEST_CORNERS && zone.points.every(isPoint),
  );
}

function isPoint(value: unknown): boolean {
  return Array.isArray(value) && value.length === 2 && value.every((each) => Number.isFinite(each));
}
