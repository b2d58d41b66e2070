/** What people mostly draw next after the step that they have just made; pure. */
import { isRobot } from "@/map/devices/device";
import type { MapPlace } from "@/map/floor/floor";
import { type ProgramDocument, type Step, textOf, type Value } from "@/program/document/document";
import { readTree } from "@/program/document/tree";
import { operable } from "@/program/operation";
import type { Method, SiteDevice, Surroundings } from "@/program/surroundings";
import { branchOf } from "../edits/joints";

export interface Carried {
  readonly quantity: Value;
  readonly object: Value;
}

export type NextStep =
  | { readonly do: "operate"; readonly at: SiteDevice; readonly method: Method }
  | { readonly do: "carry"; readonly from: SiteDevice; readonly to: SiteDevice; readonly load: Carried }
  | { readonly do: "drive"; readonly to: MapPlace };

interface Site {
  readonly document: ProgramDocument;
  readonly surroundings: Surroundings;
}

/** More than these would have to be read before they can be pressed. */
const METHODS = 2;
const TARGETS = 2;
const PARKING = ["dock", "charger", "parking"];

/** Nothing where the step has one behind it already, or where it is not at a machine. */
export function nextSteps(site: Site, id: string): readonly NextStep[] {
  const { document, surroundings } = site;
  const step = document.steps[id];
  const branch = branchOf(document, id);
  if (!step || !branch || readTree(document).children(branch.parent, branch.branch).at(-1) !== id) return [];
  const here = machineOf(step, surroundings);
  if (!here) return [];
  const delivered = step.kind === "pick_and_drop" || step.kind === "drop";
  const methods = delivered ? operable(here).slice(0, METHODS) : [];
  return [
    ...methods.map((method): NextStep => ({ do: "operate", at: here, method })),
    ...carriesFrom(site, here, id),
    ...parkingNear(here, surroundings).map((to): NextStep => ({ do: "drive", to })),
  ];
}

/** The key of a suggestion: equal ones are the same. */
export function keyOfNext(next: NextStep): string {
  if (next.do === "operate") return `operate ${next.at.id} ${next.method.name}`;
  return next.do === "carry" ? `carry ${next.from.id} ${next.to.id}` : `drive ${next.to.id}`;
}

/** The machine that the step ends at. */
function machineOf(step: Step, { devices }: Surroundings): SiteDevice | undefined {
  const field = { pick_and_drop: "target", drop: "at", operate: "device" }[step.kind];
  const place = field === undefined ? null : step.params[field];
  const id = typeof place === "object" && place !== null && "device" in place ? textOf(place.device) : "";
  const found = devices.get(id);
  return found && !isRobot(found) ? found : undefined;
}

function carriesFrom(site: Site, from: SiteDevice, id: string): NextStep[] {
  const load = loadAt(site, from, id);
  const object = textOf(load.object);
  const others = [...site.surroundings.devices.values()].filter(
    (each) => each.id !== from.id && !isRobot(each) && each.lifecycle !== "pending" && each.takes.includes(object),
  );
  const unused = (device: SiteDevice) => (usedIn(site.document, device.id) ? 1 : 0);
  return others
    .sort((one, other) => unused(one) - unused(other) || far(from, one) - far(from, other))
    .slice(0, TARGETS)
    .map((to) => ({ do: "carry", from, to, load }));
}

/** What was brought to the machine last, if it gives that; else one of what it gives. */
function loadAt({ document, surroundings }: Site, machine: SiteDevice, before: string): Carried {
  const { reading } = readTree(document);
  const brought = reading
    .slice(0, reading.indexOf(before) + 1)
    .map((id) => document.steps[id])
    .findLast((step) => step?.kind !== "operate" && step && machineOf(step, surroundings)?.id === machine.id);
  const object = textOf(brought?.params.object);
  if (brought && machine.gives.includes(object)) return { object, quantity: (brought.params.quantity ?? 1) as Value };
  return { object: machine.gives[0] ?? null, quantity: 1 };
}

function usedIn(document: ProgramDocument, device: string): boolean {
  return Object.values(document.steps).some(({ params }) =>
    [params.source, params.target, params.at].some(
      (place) => typeof place === "object" && place !== null && "device" in place && place.device === device,
    ),
  );
}

function parkingNear(here: SiteDevice, { places }: Surroundings): MapPlace[] {
  const parking = [...places.values()].filter((place) => PARKING.includes(place.kind));
  const away = (place: MapPlace) => Math.hypot(place.x - here.location.x, place.y - here.location.y);
  return parking.sort((one, other) => away(one) - away(other)).slice(0, 1);
}

function far(one: SiteDevice, other: SiteDevice): number {
  return Math.hypot(one.location.x - other.location.x, one.location.y - other.location.y);
}
