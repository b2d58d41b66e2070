/** Opens the form that tries a method, or says why it cannot be tried. */
import { Button, Tooltip } from "@mantine/core";
import { Play } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { mayOperate } from "@/api/roles";
import type { Device, DeviceMethod, Site } from "@/api/types";
import { TryMethod } from "./TryMethod";

/** Why a method cannot be tried now; null when it can. */
function hindrance(
  site: Site,
  device: Device,
  method: DeviceMethod,
): "onlyOperators" | "inPrograms" | "offline" | null {
  if (!mayOperate(site.role)) return "onlyOperators";
  if (device.kind === "robot" && method.name === "move") return "inPrograms";
  return device.status === "offline" ? "offline" : null;
}

interface TryButtonProps {
  site: Site;
  device: Device;
  method: DeviceMethod;
  /** What stands on the button where it is more than one of many, and whether it is the main thing to press there. */
  words?: string;
  main?: boolean;
}

export function TryButton({ site, device, method, words, main = false }: TryButtonProps) {
  const { t } = useTranslation();
  const [open, setOpen] = useState(false);
  const why = hindrance(site, device, method);
  return (
    <>
      <Tooltip label={why ? t(`device.try.${why}`) : t("device.try.openOf", { method: method.name })}>
        <Button
          size={words ? "sm" : "compact-sm"}
          variant={main ? "filled" : "default"}
          aria-label={words ? undefined : t("device.try.openOf", { method: method.name })}
          aria-disabled={why !== null}
          data-disabled={why !== null || undefined}
          leftSection={<Play size={13} aria-hidden="true" />}
          onClick={() => setOpen(why === null)}
        >
          {words ?? t("device.try.open")}
        </Button>
      </Tooltip>
      {open ? <TryMethod site={site} device={device} method={method} onClose={() => setOpen(false)} /> : null}
    </>
  );
}
