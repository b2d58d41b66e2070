/** How a list of alerts changes by a live message; pure. */
import type { Alert } from "@/api/types";

/** Put an alert into the list of those that are not over: a known one is replaced, one that is over is taken out. */
export function applyAlert(alerts: readonly Alert[], alert: Alert): Alert[] {
  const rest = alerts.filter((each) => each.id !== alert.id);
  return alert.state === "over" ? rest : [alert, ...rest];
}
