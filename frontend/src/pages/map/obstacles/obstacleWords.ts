/** An obstacle in words: how wide it is, and where. */
import i18n from "i18next";
import type { Obstacle } from "@/api/types";
import { formatNumber, formatPoint, withUnit } from "@/i18n/format";

export function obstacleWords({ x, y, size_m }: Omit<Obstacle, "id">): string {
  return i18n.t("obstacle.at", { size: withUnit(formatNumber(size_m * 100), "cm"), at: formatPoint(x, y) });
}
