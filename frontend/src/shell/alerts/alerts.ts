/** Which alerts are shown, in which order, and what is new among them; pure. */
import type { Alert, AlertSeverity, Role } from "@/api/types";

const RANKS: Readonly<Record<AlertSeverity, number>> = { error: 2, warning: 1, info: 0 };

/** Whether an alert concerns somebody of this role. */
export function concerns(alert: Alert, role: Role | undefined): boolean {
  return alert.role !== "admin" || role === "admin";
}

/** The worst first, of the same severity the latest first. */
export function sortAlerts(alerts: readonly Alert[]): Alert[] {
  return [...alerts].sort(
    (a, b) => RANKS[b.severity] - RANKS[a.severity] || b.last_at.localeCompare(a.last_at) || b.id - a.id,
  );
}

export function inState(alerts: readonly Alert[], state: Alert["state"]): Alert[] {
  return alerts.filter((alert) => alert.state === state);
}

/** The worst severity among alerts; null where there are none. */
export function worstOf(alerts: readonly Alert[]): AlertSeverity | null {
  return sortAlerts(alerts)[0]?.severity ?? null;
}

/** The alerts of each device, the worst first. */
export function byDevice(alerts: readonly Alert[]): ReadonlyMap<string, Alert[]> {
  const found = new Map<string, Alert[]>();
  for (const alert of sortAlerts(alerts)) found.set(alert.device, [...(found.get(alert.device) ?? []), alert]);
  return found;
}

/** How often each alert had been raised. */
export type Known = ReadonlyMap<number, number>;

export function knownOf(alerts: readonly Alert[]): Known {
  return new Map(alerts.map((alert) => [alert.id, alert.count]));
}

/** The errors that nobody has seen and that are new since; none when nothing was known before. */
export function freshErrors(known: Known | null, alerts: readonly Alert[]): Alert[] {
  if (!known) return [];
  return inState(alerts, "open").filter(
    (alert) => alert.severity === "error" && (known.get(alert.id) ?? 0) < alert.count,
  );
}

/** The devices that steps name, at any depth of what they hold. */
export function devicesIn(value: unknown): string[] {
  if (typeof value !== "object" || value === null) return [];
  return Object.entries(value).flatMap(([key, held]) =>
    key === "device" && typeof held === "string" ? [held] : devicesIn(held),
  );
}
