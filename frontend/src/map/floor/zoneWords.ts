/** What is written on a zone of the floor. */
import type { TFunction } from "i18next";
import { formatNumber, formatTime, withUnit } from "@/i18n/format";
import type { MapZone } from "./floor";
import { openUntil } from "./openZones";

type Rule = Omit<MapZone, "id" | "name" | "points">;

/** Its rule at a time, milliseconds: "Keep out", "At most 0.3 m/s", "2 robots", "Released until 14:00". */
export function ruleWords(zone: Rule, t: TFunction, at = Date.now()): string {
  return shortWords(zone, t, arrowOf(zone.heading_deg ?? 0), at);
}

/** What its sign on the map says, long and short; the sign has an arrow of its own. */
export function signWords(zone: MapZone, t: TFunction, at: number): [string, string] {
  const rule = shortWords(zone, t, "", at);
  return [t("zone.says", { rule, name: zone.name }), rule];
}

function shortWords(zone: Rule, t: TFunction, arrow: string, at: number): string {
  const { rule, speed_m_s, robots } = zone;
  const until = openUntil(zone, at);
  if (until) return t("zone.short.open", { time: formatTime(until) });
  return t(`zone.short.${rule}`, { speed: speedWords(speed_m_s ?? 0), count: robots ?? 1, arrow }).trim();
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
