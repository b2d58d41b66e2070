/** What is written on a zone of the floor. */
import type { TFunction } from "i18next";
import { formatNumber, withUnit } from "@/i18n/format";
import type { MapZone } from "./floor";

/** Its rule and its name: "Keep out, service aisle". */
export function zoneWords({ name, rule, speed_m_s }: MapZone, t: TFunction): string {
  if (rule !== "slow") return t(`zone.says.${rule}`, { name });
  return t("zone.says.slow", { name, speed: withUnit(formatNumber(speed_m_s ?? 0, 2), "m/s") });
}
