/** What a wall screen says of a run: how it is, or when it begins, with the day where that is not today. */
import i18next from "i18next";
import { formatMoment, formatTime } from "@/i18n/format";
import type { WallRun } from "./wall";

const dayOf = (at: number | string) => new Date(at).toDateString();

/** `now` in milliseconds since 1970. */
export function statusWords(run: Pick<WallRun, "status" | "not_before">, now: number): string {
  const begin = run.status === "pending" ? run.not_before : null;
  if (!begin) return i18next.t(`wall.status.${run.status}`);
  return dayOf(begin) === dayOf(now)
    ? i18next.t("wall.status.planned", { time: formatTime(begin) })
    : i18next.t("wall.status.plannedOn", { moment: formatMoment(begin) });
}
