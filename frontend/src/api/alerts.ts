/** Alerts: what about a device people should know and deal with. */
export type AlertSeverity = "info" | "warning" | "error";
export type AlertState = "open" | "seen" | "over";

export interface Alert {
  id: number;
  device: string;
  code: string;
  severity: AlertSeverity;
  /** The least role that it concerns. */
  role: "viewer" | "admin";
  /** `why` in the device's own words, `method`, `faults`. */
  args: Record<string, unknown>;
  /** The English sentence. */
  text: string;
  /** How often it was raised since `first_at`. */
  count: number;
  state: AlertState;
  first_at: string;
  last_at: string;
  over_at: string | null;
  seen_by: string;
  seen_at: string | null;
}
