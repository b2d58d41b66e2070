/** What came to pass between robots in a rehearsal: who touched, came too near, or waited; numbered in time. Pure. */
import type { NearMiss, RehearsalResult } from "@/api/types";
import { poseAt } from "./frames";

export type IncidentKind = "collision" | "near" | "wait";
type Wait = RehearsalResult["waits"][number];

export interface Incident {
  /** From 1, as the list, the bar, the map and the 3D view have it. */
  readonly number: number;
  readonly kind: IncidentKind;
  readonly t_s: number;
  readonly until_s: number;
  /** Metres; null where nobody knows where it was. */
  readonly at: readonly [number, number] | null;
  readonly robot: string;
  readonly encounter: NearMiss | null;
  readonly wait: Wait | null;
}

/** So long two that met are shown as being about it. */
const MEETING_S = 3;
/** More than these are shown only near their moment: they would cover the map. */
const MOST_AT_ONCE = 40;
const AROUND_S = 30;

export function incidentsOf(result: RehearsalResult): Incident[] {
  const met = (kind: IncidentKind) => (encounter: NearMiss) => ({
    kind,
    t_s: encounter.t,
    until_s: encounter.t + MEETING_S,
    at: [encounter.x, encounter.y] as const,
    robot: encounter.a,
    encounter,
    wait: null,
  });
  const waited = (wait: Wait) => {
    const pose = poseAt(result.frames, wait.robot, wait.t);
    return {
      kind: "wait" as const,
      t_s: wait.t,
      until_s: wait.t + wait.duration_s,
      at: pose && ([pose[0], pose[1]] as const),
      robot: wait.robot,
      encounter: null,
      wait,
    };
  };
  return [
    ...result.collisions.map(met("collision")),
    ...result.near_misses.map(met("near")),
    ...result.waits.map(waited),
  ]
    .sort((a, b) => a.t_s - b.t_s)
    .map((each, index) => ({ ...each, number: index + 1 }));
}

export const isNow = ({ t_s, until_s }: Incident, now_s: number): boolean => now_s >= t_s - 0.05 && now_s <= until_s;

/** Those that are drawn at a moment: all, or of very many those around it. */
export function drawnAt(incidents: readonly Incident[], now_s: number): readonly Incident[] {
  if (incidents.length <= MOST_AT_ONCE) return incidents;
  return incidents.filter(({ t_s, until_s }) => now_s >= t_s - AROUND_S && now_s <= until_s + AROUND_S);
}
