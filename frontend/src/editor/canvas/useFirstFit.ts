/** When the map is brought into the free area by itself. */
import { useEffect, useRef } from "react";
import type { FloorPlan } from "@/map/floor";
import type { Viewport } from "@/map/projection";
import type { StageHandle } from "./stageContext";

/**
 * The map is brought into the free area when it is first there, and again when what stands below it opens or closes;
 * once people have moved it, it stays where they put it.
 */
export function useFirstFit(
  fit: (animate: boolean) => Viewport | null,
  plan: FloorPlan | null,
  bottom: number,
  viewport: StageHandle["viewport"],
): void {
  const last = useRef<{ plan: FloorPlan; bottom: number; view: Viewport | null } | null>(null);
  useEffect(() => {
    const before = last.current;
    if (!plan || (before?.plan === plan && before.bottom === bottom)) return;
    const moved = before?.plan === plan && !isSameView(before.view, viewport.get());
    last.current = { plan, bottom, view: moved ? null : fit(false) };
  }, [fit, plan, bottom, viewport]);
}

function isSameView(one: Viewport | null, other: Viewport): boolean {
  return one !== null && one.zoom === other.zoom && one.x === other.x && one.y === other.y;
}
