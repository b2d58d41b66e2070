/** What is wrong with VIPO's own processes, in words, and who is told. */
import i18next from "i18next";
import { mayOperate } from "@/api/roles";
import type { Finding, Role } from "@/api/types";
import { formatNumber, formatSpan, withUnit } from "@/i18n/format";

/** Operators and whoever may more have the page of operations. */
export function seesOperations(role: Role | undefined): boolean {
  return mayOperate(role);
}

/** A finding as a sentence in the language of the screen; one that this page does not know yet as the server says it. */
export function findingWords(finding: Finding): string {
  const { kind, name, machine, seconds, why, count } = finding.args as Record<string, string | number | undefined>;
  const apart = typeof seconds === "number" ? seconds : 0;
  const way = apart < 0 ? "_behind" : "_ahead";
  const key = `operations.finding.${finding.code}${finding.code === "clock_apart" ? way : ""}`;
  if (!i18next.exists(key)) return finding.text;
  return i18next.t(key, {
    kind: kind ? i18next.t(`operations.kind.${kind}`) : "",
    name,
    machine,
    why,
    count,
    ago: formatSpan(apart),
    seconds: withUnit(formatNumber(Math.abs(apart), 1), "s"),
  });
}

/** What was set aside has a part of the page of operations; this is its anchor, and the code of its finding. */
export const SET_ASIDE = "set_aside";

/** Where somebody does something about a finding. */
export function pageOf(finding: Finding, slug: string): string {
  const page = `/sites/${slug}/operations`;
  return finding.code === SET_ASIDE ? `${page}#${SET_ASIDE}` : page;
}

/** What every screen says: that work stands still, or cannot be relied on. */
export function gravest(findings: readonly Finding[]): Finding[] {
  return findings.filter((finding) => finding.severity === "error");
}
