/** What two rehearsals are compared by; pure. */
import type { RehearsalResult } from "@/api/types";

export interface Figures {
  duration_s: number;
  distance_m: number;
  /** How many robots drove. */
  robots: number;
  waits: number;
  waited_s: number;
  /** Near misses and collisions. */
  encounters: number;
  steps: number;
}

/** Less is standing still: wheels turn a little where a robot is placed. */
const DROVE_M = 0.05;

export function figuresOf(result: RehearsalResult): Figures {
  const driven = Object.values(result.robots).filter((robot) => robot.distance_m > DROVE_M);
  return {
    duration_s: result.duration_s,
    distance_m: driven.reduce((sum, robot) => sum + robot.distance_m, 0),
    robots: driven.length,
    waits: result.waits.length,
    waited_s: result.waits.reduce((sum, wait) => sum + wait.duration_s, 0),
    encounters: result.near_misses.length + result.collisions.length,
    steps: result.steps.length,
  };
}

/** The devices that only one of the two has used, by id. */
export function usedByOne(old: RehearsalResult, next: RehearsalResult): { old: string[]; new: string[] } {
  const before = usedBy(old);
  const after = usedBy(next);
  return {
    old: [...before].filter((id) => !after.has(id)).sort(),
    new: [...after].filter((id) => !before.has(id)).sort(),
  };
}

function usedBy(result: RehearsalResult): ReadonlySet<string> {
  const devices = result.steps.flatMap(({ robot, device }) => [robot, device]);
  return new Set(devices.filter((id) => id !== ""));
}
