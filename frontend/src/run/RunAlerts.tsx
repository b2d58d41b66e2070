/** What is wrong with the devices that take part in a run. */
import { useMemo } from "react";
import type { Run } from "@/api/types";
import { devicesIn } from "@/shell/alerts/alerts";
import { DeviceAlerts } from "@/shell/alerts/DeviceAlerts";

export function RunAlerts({ run }: { run: Run }) {
  const { roles, document } = run;
  const devices = useMemo(
    () => [...new Set([...Object.values(roles), ...devicesIn(document.steps)])],
    [roles, document],
  );
  return <DeviceAlerts slug={run.site} devices={devices} brief />;
}
