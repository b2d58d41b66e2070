/** The way that somebody drew for a step: its bends, kept with it in metres. */
import type { Position } from "./edits";
import type { Step } from "./types";

/** The bends that somebody drew; null for the automatic way. */
export function drawnRoute(step: Step | undefined): readonly Position[] | null {
  const route = step?.params.route;
  if (!Array.isArray(route) || route.length === 0) return null;
  const sound = route.every((point) => Array.isArray(point) && point.length === 2 && point.every(Number.isFinite));
  return sound ? (route as Position[]) : null;
}
