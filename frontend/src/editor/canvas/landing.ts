/** A chip that was set down before its path was known comes onto it once it is, unless somebody has moved it. */
import { useCallback, useEffect, useRef } from "react";
import { isRobot } from "@/map/devices/device";
import type { Point } from "@/map/plane/projection";
import type { ProgramDocument } from "@/program/document/document";
import { spotOnRoute } from "../state/placement";
import type { RouteLookup, StepPath } from "@/program/scene/stepPaths";
import { routePoints } from "@/program/scene/scene";
import { deviceBox } from "@/program/surroundings";
import type { OpenProgram } from "../state/context";

export interface Landing {
  readonly id: string;
  /** Where it was set down. */
  readonly pos: Point;
  readonly key: string;
  readonly ends: Pick<StepPath, "from" | "to">;
}

export function useLanding(open: OpenProgram, routes: RouteLookup): (landing: Landing) => void {
  const waiting = useRef<readonly Landing[]>([]);
  const { document, scene, devices, shared } = open;
  useEffect(() => {
    const come = waiting.current.filter(({ key }) => routes(key) !== undefined);
    if (come.length === 0) return;
    waiting.current = waiting.current.filter((landing) => !come.includes(landing));
    const machines = devices.filter((device) => !isRobot(device)).map(deviceBox);
    for (const { id, pos, key, ends } of come) {
      const path = routes(key);
      if (!path || !standsStill(document, id, pos)) continue;
      const others = [...scene.chips.values()].filter((chip) => chip.id !== id).map((chip) => chip.box);
      shared.adjust([{ do: "set_pos", id, pos: spotOnRoute(routePoints(ends, path), [...others, ...machines]) }]);
    }
  }, [routes, document, scene, devices, shared]);
  return useCallback((landing) => {
    waiting.current = [...waiting.current, landing];
  }, []);
}

export function standsStill(document: ProgramDocument, id: string, pos: Point): boolean {
  const now = document.steps[id]?.pos;
  return now?.[0] === pos[0] && now[1] === pos[1];
}
