/** An alert in the language of the screen; the server's English where a code is newer than this page. */
import i18next from "i18next";
import { faultsOf } from "@/i18n/faults";
import type { Alert, AlertSeverity } from "@/api/types";
import type { StatusName } from "@/design/StatusGlyph";
import { faultsWords } from "@/i18n/faults";

export function alertWords(alert: Alert): string {
  return i18next.t(`alerts.what.${alert.code}`, { ...alert.args, defaultValue: alert.text });
}

/** What the device, or whoever refused something, said itself; what VIPO refused is told in the screen's language. */
export function ownWords(alert: Alert): string {
  const faults = faultsOf(alert.args);
  if (faults.length > 0) return faultsWords(faults);
  return typeof alert.args.why === "string" ? alert.args.why : "";
}

const SIGNS: Readonly<Record<AlertSeverity, StatusName>> = { error: "error", warning: "warning", info: "pending" };

/** The sign whose shape tells the severity. */
export function signOf(severity: AlertSeverity): StatusName {
  return SIGNS[severity];
}
