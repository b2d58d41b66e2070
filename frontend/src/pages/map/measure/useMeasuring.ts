/** What somebody measures on a map, by pointer and by keys; gone when they have finished. */
import { useEffect, useState } from "react";
import type { SiteMap } from "@/api/types";
import type { MapDevice } from "@/map/devices/device";
import type { Point } from "@/map/plane/projection";
import { freeMiddle } from "../places/newPlace";
import * as steps from "./measuring";
import { machineEdges, REACH_M, snapped, wallEdges } from "./snapping";

export interface MeasureView {
  readonly measuring: steps.Measuring;
  /** A pointer at a point snaps to what is within `reach` metres. */
  readonly aim: (at: Point, reach: number) => void;
  readonly press: (at: Point, reach: number) => void;
  readonly release: (at: Point, reach: number) => void;
  readonly leave: () => void;
  readonly cancel: () => void;
  /** Where the cross-hair stands or would begin. */
  readonly cross: () => Point;
  readonly step: (to: Point) => void;
  /** An end where the cross-hair is. */
  readonly put: () => void;
  /** Takes the line away; false where there is none. */
  readonly clear: () => boolean;
}

export function useMeasuring(map: SiteMap, devices: readonly MapDevice[], isOn: boolean): MeasureView {
  const [measuring, set] = useState(steps.NOTHING);
  useEffect(() => {
    if (!isOn) set(steps.NOTHING);
  }, [isOn]);
  const snap = (at: Point, reach: number) =>
    snapped(at, [...wallEdges(map, at, reach), ...machineEdges(devices)], reach);
  const cross = () => measuring.cross ?? freeMiddle(map);
  return {
    measuring,
    aim: (at, reach) => set((last) => steps.aimed(last, snap(at, reach))),
    press: (at, reach) => set((last) => steps.pressed(last, at, snap(at, reach))),
    release: (at, reach) => set((last) => steps.released(last, at, snap(at, reach), reach)),
    leave: () => set(steps.left),
    cancel: () => set(steps.cancelled),
    cross,
    step: (to) => set((last) => steps.stepped(last, to, snap(to, REACH_M))),
    put: () => {
      const at = cross();
      const end = snap(at, REACH_M);
      set((last) => steps.withEnd(steps.stepped(last, at, end), end));
    },
    clear: () => {
      set(steps.cleared);
      return measuring.ends.length > 0;
    },
  };
}
