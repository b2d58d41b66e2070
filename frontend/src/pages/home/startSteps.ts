/** How far a site is from nothing to its first program, and who does what is next. Pure. */
import type { Role } from "@/api/types";

export type StartKey = "map" | "places" | "devices" | "program";

export interface StartStep {
  readonly key: StartKey;
  readonly done: boolean;
  /** The least role that may do it. */
  readonly needs: "admin" | "author";
}

interface Known {
  readonly hasMap: boolean;
  readonly places: number;
  readonly devices: number;
  readonly programs: number;
}

export function startSteps({ hasMap, places, devices, programs }: Known): readonly StartStep[] {
  return [
    { key: "map", done: hasMap, needs: "admin" },
    { key: "places", done: places > 0, needs: "admin" },
    { key: "devices", done: devices > 0, needs: "admin" },
    { key: "program", done: programs > 0, needs: "author" },
  ];
}

export function mayDo(role: Role | undefined, { needs }: Pick<StartStep, "needs">): boolean {
  return role === "admin" || role === needs;
}

/** Where a step is done; the first program is made there. */
export function whereTo(slug: string, key: Exclude<StartKey, "program">): string {
  const path = { map: "map/new", places: "map?places", devices: "devices" }[key];
  return `/sites/${slug}/${path}`;
}
