/** Zones as polygons; pure, metres. */
import { FEWEST_CORNERS } from "@/program/canvas/Zones";
import type { Position, ProgramDocument, Zone } from "@/program/document/document";

export const ZONE_RULES = ["keep_out", "one_at_a_time", "slow", "door"] as const;
const SLOW_M_S = 0.3;
const SIDE_M = 2;

/** The area that the corners enclose, in square metres. */
export function areaOf(points: readonly Position[]): number {
  const twice = points.reduce((sum, [x, y], index) => {
    const [nextX, nextY] = points[(index + 1) % points.length] ?? [x, y];
    return sum + x * nextY - nextX * y;
  }, 0);
  return Math.abs(twice) / 2;
}

/** A corner is not set twice at one spot: a double click adds one, not two. */
export function withNextCorner(corners: readonly Position[], at: Position): readonly Position[] {
  const last = corners.at(-1);
  return last && distance(last, at) < 0.05 ? corners : [...corners, at];
}

export function closes(corners: readonly Position[], at: Position, reach: number): boolean {
  const [first] = corners;
  return first !== undefined && corners.length >= FEWEST_CORNERS && distance(first, at) <= reach;
}

export function squareAround([x, y]: Position): readonly Position[] {
  const half = SIDE_M / 2;
  return [
    [x - half, y - half],
    [x + half, y - half],
    [x + half, y + half],
    [x - half, y + half],
  ];
}

export function freshZone(name: string, points: readonly Position[]): Zone {
  return { name, rule: "slow", points, speed_m_s: SLOW_M_S };
}

/** A number that no zone's name ends with yet. */
export function freshNumber(document: ProgramDocument): number {
  const taken = Object.values(document.zones).map((zone) => Number(/\d+$/.exec(String(zone?.name))?.[0] ?? 0));
  return Math.max(0, ...taken) + 1;
}

function distance(one: Position, other: Position): number {
  return Math.hypot(one[0] - other[0], one[1] - other[1]);
}
