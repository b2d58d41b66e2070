/** What was done as a sentence without its subject, and who did it from where; in the language of the screen. */
import i18next from "i18next";
import type { AuditEntry } from "@/api/types";
import { formatDay, formatMoment, formatNumber } from "@/i18n/format";

const ROLES = ["role", "before", "after"];

/** The name by which the one who did it stands at the beginning. */
export function actorWords(line: AuditEntry): string {
  if (line.actor_kind === "token") return i18next.t("people.audit.actor.token", { name: line.actor });
  return line.actor || i18next.t("people.audit.actor.vipo");
}

/** Such as “changed Tom West from Operator to Viewer”. */
export function deedWords(line: AuditEntry): string {
  return i18next.t(`people.audit.what.${variantOf(line)}`, Object.fromEntries(factsOf(line)));
}

function variantOf({ code, facts }: AuditEntry): string {
  if (code === "access_end_set" && facts.until === null) return "access_end_none";
  if (code === "invitation_made" && facts.email) return "invitation_mailed";
  if (code === "second_factor_demanded" && !facts.role) return "second_factor_demanded_none";
  if (code === "run_started" && facts.armed) return "run_armed";
  return code;
}

function factsOf(line: AuditEntry): [string, unknown][] {
  return Object.entries(line.facts as Record<string, unknown>).map(([name, value]) => {
    if (ROLES.includes(name)) return [name, i18next.t(`role.${String(value)}`)];
    if (name === "why") return [name, i18next.t(`people.audit.signOn.${String(value)}`)];
    if (name === "because") return [name, i18next.t(`people.audit.turnedAway.${String(value)}`)];
    if (name === "until" && typeof value === "string") return [name, formatMoment(value)];
    if (typeof value === "number" && !Number.isInteger(value)) return [name, formatNumber(value, 2)];
    return [name, value];
  });
}

/** Where it came from, as far as that is known: “from 10.0.0.7, Firefox on Linux”. */
export function placeWords({ address, browser, system }: AuditEntry): string {
  const by = browser && system ? i18next.t("people.audit.with", { browser, system }) : browser || system;
  return [address ? i18next.t("people.audit.from", { address }) : "", by].filter(Boolean).join(", ");
}

/** The day of a line as a heading: today, yesterday, or its date. */
export function dayWords(at: string, now: number): string {
  const of = new Date(at).toDateString();
  const day = new Date(now);
  if (of === day.toDateString()) return i18next.t("people.audit.today");
  day.setDate(day.getDate() - 1); // a day is 23 hours long when summer time begins, and 25 when it ends
  if (of === day.toDateString()) return i18next.t("people.audit.yesterday");
  return formatDay(at);
}

/** Lines with the same day together, in their order. */
export function byDay(lines: readonly AuditEntry[], now: number): [day: string, lines: AuditEntry[]][] {
  const days = new Map<string, AuditEntry[]>();
  for (const line of lines) {
    const day = dayWords(line.at, now);
    days.set(day, [...(days.get(day) ?? []), line]);
  }
  return [...days];
}
