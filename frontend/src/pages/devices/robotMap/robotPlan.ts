import type { RobotMap } from "@/api/types";
import type { FloorPlan } from "@/map/floor/floor";

/** A robot's map as a floor for drawing; it knows no places. */
export function planOf(map: RobotMap): FloorPlan {
  return { ...map, places: [] };
}
