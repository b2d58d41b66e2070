/** What is written on a zone of the floor. */
import type { TFunction } from "i18next";
import { formatNumber, withUnit } from "@/i18n/format";
import type { MapZone } from "./floor";

/** Its rule: "Keep out", "At most 0.3 m/s", "2 robots". */
export function ruleWords(zone: Omit<MapZone, "id" | "name" | "points">, t: TFunction): string {
  const { rule, speed_m_s, robots, heading_deg } = zone;
  return t(`zone.short.${rule}`, {
    speed: speedWords(speed_m_s ?? 0),
    count: robots ?? 1,
    arrow: arrowOf(heading_deg ?? 0),
  });
}

const ARROWS = ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"] as const;

/** The arrow that is nearest to a direction. */
export function arrowOf(heading_deg: number): string {
  return ARROWS[((Math.round(heading_deg / 45) % 8) + 8) % 8] ?? ARROWS[0];
}

/** Its rule and its name: "Keep out, service aisle". */
export function zoneWords(zone: MapZone, t: TFunction): string {
  return t("zone.says", { rule: ruleWords(zone, t), name: zone.name });
}

function speedWords(speed_m_s: number): string {
  const digits = Number.isInteger(Math.round(speed_m_s * 1000) / 100) ? 1 : 2;
  return withUnit(formatNumber(speed_m_s, digits), "m/s");
}
