/** What a small picture of steps shows: the machines it touches and the paths between them. Pure. */
import type { Device, Place, Point, Step } from "@/api/types";
import { boxAround, toPixels, type Box } from "@/map/plane/projection";

const MARGIN_M = 1.6;

/** A function's definition, or a whole document. */
export type Drawn = { readonly steps: Readonly<Record<string, Step>> } | undefined;

export interface PathWanted {
  readonly from: Place;
  readonly to: Place;
}

function isPlace(value: unknown): value is Place {
  return typeof value === "object" && value !== null;
}

function deviceOf(place: unknown): string | null {
  return isPlace(place) && "device" in place ? place.device : null;
}

const FIELDS = ["source", "target", "at", "to", "device"] as const;

/** Ids of the devices that the steps name. */
export function devicesIn(definition: Drawn): string[] {
  const steps = Object.values(definition?.steps ?? {});
  const named = steps.flatMap((step) => FIELDS.map((field) => deviceOf(step.params[field])));
  return [...new Set(named.filter((id) => id !== null))];
}

/** The paths its Pick-and-Drops take, where both ends are known. */
export function pathsIn(definition: Drawn): PathWanted[] {
  const steps: Step[] = Object.values(definition?.steps ?? {});
  return steps
    .filter((step) => step.kind === "pick_and_drop")
    .map((step) => ({ from: step.params.source, to: step.params.target }))
    .filter((path): path is PathWanted => deviceOf(path.from) !== null && deviceOf(path.to) !== null);
}

/** The part of the map around the devices and paths (drawing pixels); undefined when there are none. */
export function focusOn(devices: readonly Device[], paths: readonly (readonly Point[])[]): Box | undefined {
  const corners = [...devices.map(({ location }) => [location.x, location.y] as const), ...paths.flat()];
  const grown = corners.flatMap(([x, y]) => [
    toPixels([x - MARGIN_M, y - MARGIN_M]),
    toPixels([x + MARGIN_M, y + MARGIN_M]),
  ]);
  return boxAround(grown) ?? undefined;
}
