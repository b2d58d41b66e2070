/** What a drawing needs of the site: its devices and named places, found by id. */
import type { MapDevice } from "@/map/devices/device";
import { footprint, isRobot } from "@/map/devices/device";
import type { MapPlace } from "@/map/floor/floor";
import { toPixels, type Box } from "@/map/plane/projection";
import type { PixelPoint } from "@/map/plane/paths";
import { ownEntry } from "@/design/ownEntry";
import type { Place, ProgramDocument } from "./document/document";
import { isPoint } from "./document/wellFormed";

export interface MethodParameter {
  readonly name: string;
  readonly type?: string | null;
  readonly unit?: string | null;
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  readonly options?: readonly unknown[] | null;
  readonly required?: boolean;
}

export interface Method {
  readonly name: string;
  readonly title?: string | null;
  readonly parameters: readonly MethodParameter[];
}

export interface Property {
  readonly name: string;
  readonly type?: string | null;
  readonly unit?: string | null;
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  readonly value: unknown;
}

/** A device as the editor uses it: its look on the map and what it can do. */
export interface SiteDevice extends MapDevice {
  readonly methods: readonly Method[];
  readonly properties: readonly Property[];
  readonly gives: readonly string[];
  readonly takes: readonly string[];
  readonly capacity?: number | null;
  readonly lifecycle?: string;
}

export interface Surroundings {
  readonly devices: ReadonlyMap<string, SiteDevice>;
  readonly places: ReadonlyMap<string, MapPlace>;
}

export function surroundingsOf(devices: readonly SiteDevice[], places: readonly MapPlace[]): Surroundings {
  return {
    devices: new Map(devices.map((device) => [device.id, device])),
    places: new Map(places.map((place) => [place.id, place])),
  };
}

/** A place on the drawing plane; `box` is the outline to stop at, where there is one. */
export interface Spot {
  readonly name: string;
  readonly at: PixelPoint;
  readonly box: Box | null;
  readonly place: Place;
}

/** Where a place is; null where it is not said or not known. A parameter is what the first call gives it. */
export function spotOf(
  value: unknown,
  surroundings: Surroundings,
  document: ProgramDocument,
  functionId: string | null,
): Spot | null {
  const place = functionId ? argumentOf(value, document, functionId) : value;
  if (typeof place !== "object" || place === null) return null;
  if ("device" in place) return deviceSpot(place as { device: string }, surroundings);
  if ("place" in place) {
    const found = surroundings.places.get(String(place.place));
    if (!found) return null;
    return { name: found.name, at: toPixels([found.x, found.y]), box: null, place: place as Place };
  }
  if ("point" in place && isPoint(place.point)) {
    const [x, y] = place.point;
    return { name: `${x}, ${y}`, at: toPixels([x, y]), box: null, place: place as Place };
  }
  return null;
}

function deviceSpot(place: { device: string }, surroundings: Surroundings): Spot | null {
  const device = surroundings.devices.get(place.device);
  if (!device || isRobot(device)) return null;
  const at = toPixels([device.location.x, device.location.y]);
  return { name: device.name, at, box: deviceBox(device), place };
}

export function deviceBox(device: MapDevice): Box {
  const at = toPixels([device.location.x, device.location.y]);
  const { width, height } = footprint(device);
  return {
    left: at.x - width / 2,
    right: at.x + width / 2,
    top: at.y - height / 2,
    bottom: at.y + height / 2,
  };
}

function argumentOf(value: unknown, document: ProgramDocument, functionId: string): unknown {
  if (typeof value !== "object" || value === null || !("param" in value)) return value;
  const name = String(value.param);
  const call = Object.values(document.steps).find(
    (step) => step.kind === "call" && step.params.function === functionId,
  );
  const args = (call?.params.args ?? {}) as Record<string, unknown>;
  const parameter = ownEntry(document.functions, functionId)?.parameters.find((each) => each.name === name);
  return ownEntry(args, name) ?? parameter?.default ?? null;
}
