/** Whom a zone concerns: what stands in it, the programs that go there, and their runs under way; pure. */
import type { Device, MapPlace, MapZone, Program, RunSummary } from "@/api/types";
import { footprint } from "@/map/devices/device";
import { PIXELS_PER_METRE, type Point } from "@/map/plane/projection";
import { holds } from "./outline";

/** Robots stand so far (m) beside a machine that they serve. */
const BESIDE_M = 0.5;

export interface ZoneUses {
  readonly places: readonly MapPlace[];
  readonly machines: readonly Device[];
  readonly programs: readonly Program[];
  readonly runs: readonly RunSummary[];
}

interface Known {
  readonly places: readonly MapPlace[];
  readonly devices: readonly Device[];
  readonly programs: readonly Program[];
  /** Those that are not over. */
  readonly runs: readonly RunSummary[];
}

export function usesOf({ points }: Pick<MapZone, "points">, known: Known): ZoneUses {
  const places = known.places.filter(({ kind, x, y }) => kind !== "room" && holds(points, [x, y]));
  const machines = known.devices.filter(
    (device) => device.kind === "machine" && around(device).some((point) => holds(points, point)),
  );
  const names = new Set([...places, ...machines].map(({ id }) => id));
  const programs = known.programs.filter((program) =>
    [...program.places, ...program.devices].some((each) => names.has(each)),
  );
  return { places, machines, programs, runs: begun(known.runs, programs) };
}

/** Of the runs that are not over those of these programs that have begun. */
export const begun = (runs: readonly RunSummary[], programs: readonly Program[]): RunSummary[] =>
  runsOf(runs, programs).filter(({ started_at: began }) => began !== null);

/** Of the runs that are not over those of these programs that have not begun yet. */
export const planned = (runs: readonly RunSummary[], programs: readonly Program[]): RunSummary[] =>
  runsOf(runs, programs).filter(({ started_at: began }) => began === null);

const runsOf = (runs: readonly RunSummary[], programs: readonly Program[]) =>
  runs.filter(({ program }) => programs.some(({ id }) => id === program.id));

/** A machine's middle, and where robots might stand on each side of it. */
function around(device: Device): Point[] {
  const { x, y } = device.location;
  const { width, height } = footprint(device);
  const [across, along] = [width / 2 / PIXELS_PER_METRE + BESIDE_M, height / 2 / PIXELS_PER_METRE + BESIDE_M];
  return [
    [x, y],
    [x - across, y],
    [x + across, y],
    [x, y - along],
    [x, y + along],
  ];
}
