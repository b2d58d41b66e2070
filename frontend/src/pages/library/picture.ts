/** What a function's picture shows: the machines it touches and the ways between them. Pure. */
import type { Device, LibraryFunction, Place, Point, Step } from "@/api/types";
import { boxAround, toPixels, type Box } from "@/map/plane/projection";

const MARGIN_M = 1.6;

export interface WayWanted {
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
export function devicesIn(definition: LibraryFunction["definition"]): string[] {
  const steps = Object.values(definition?.steps ?? {});
  const named = steps.flatMap((step) => FIELDS.map((field) => deviceOf(step.params[field])));
  return [...new Set(named.filter((id) => id !== null))];
}

/** The ways its Pick-and-Drops take, where both ends are known. */
export function waysIn(definition: LibraryFunction["definition"]): WayWanted[] {
  const steps: Step[] = Object.values(definition?.steps ?? {});
  return steps
    .filter((step) => step.kind === "pick_and_drop")
    .map((step) => ({ from: step.params.source, to: step.params.target }))
    .filter((way): way is WayWanted => deviceOf(way.from) !== null && deviceOf(way.to) !== null);
}

/** The part of the map around the devices and ways (drawing pixels); undefined when there are none. */
export function focusOn(devices: readonly Device[], ways: readonly (readonly Point[])[]): Box | undefined {
  const corners = [...devices.map(({ location }) => [location.x, location.y] as const), ...ways.flat()];
  const grown = corners.flatMap(([x, y]) => [
    toPixels([x - MARGIN_M, y - MARGIN_M]),
    toPixels([x + MARGIN_M, y + MARGIN_M]),
  ]);
  return boxAround(grown) ?? undefined;
}
