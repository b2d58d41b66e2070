/** Snapping for the chip that is held: to machines, to other chips, to the grid; Alt lets it go anywhere. */
import { useCallback, useMemo, useRef } from "react";
import { isRobot } from "@/map/device";
import type { PixelPoint } from "@/map/routePath";
import type { ViewportCell } from "@/map/viewport";
import type { Scene } from "../scene/scene";
import { deviceBox, type SiteDevice } from "../scene/surroundings";
import { portsOf, snap, type Snapped } from "./snapping";

export interface Snapping {
  readonly snapTo: (id: string, at: PixelPoint) => Snapped;
  /** Hears whether Alt is held. */
  readonly watch: (event: { readonly altKey: boolean }) => void;
}

export function useSnapping(scene: Scene, devices: readonly SiteDevice[], viewport: ViewportCell): Snapping {
  const free = useRef(false);
  const ports = useMemo(
    () => devices.filter((device) => !isRobot(device)).flatMap((each) => portsOf(deviceBox(each))),
    [devices],
  );
  const snapTo = useCallback(
    (id: string, at: PixelPoint) => {
      if (free.current) return { at, guides: [] };
      const centres = [...scene.chips.values()].filter((chip) => chip.id !== id).map((chip) => chip.at);
      return snap(at, { ports, centres }, viewport.get().zoom);
    },
    [scene, ports, viewport],
  );
  const watch = useCallback((event: { readonly altKey: boolean }) => {
    free.current = event.altKey;
  }, []);
  return { snapTo, watch };
}
