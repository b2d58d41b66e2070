/** What the program's robots report of themselves: each role that some step drives, with the readings to choose from. */
import type { ProgramDocument, Role } from "./document/document";
import { DEFAULT_ROLE, roleOfStep } from "./operation";

interface Reports {
  readonly id: string;
  readonly kind: string;
  readonly lifecycle: string;
  readonly properties: readonly { readonly name: string }[];
  readonly methods: readonly { readonly name: string }[];
}

export interface RoleReadings<Device extends Reports> {
  readonly role: string;
  /** The first robot that reports a thing stands for all: its kind, unit and range. */
  readonly readings: readonly Device["properties"][number][];
}

/** The robots that may take a role: the one that it is bound to, or all that can do what it must. */
export function robotsFor<Device extends Reports>(
  role: Role | undefined,
  devices: readonly Device[],
): readonly Device[] {
  const robots = devices.filter((each) => each.kind === "robot");
  const bound = role?.device;
  if (bound) return robots.filter((each) => each.id === bound);
  const able = (each: Device) => (role?.can ?? []).every((name) => each.methods.some((method) => method.name === name));
  return robots.filter((each) => each.lifecycle === "approved" && able(each));
}

/** What such robots report, each name once. */
export function reportedBy<Device extends Reports>(robots: readonly Device[]): readonly Device["properties"][number][] {
  const found = new Map<string, Device["properties"][number]>();
  for (const reading of robots.flatMap((each) => each.properties))
    if (!found.has(reading.name)) found.set(reading.name, reading);
  return [...found.values()];
}

/** The roles that steps drive and whose robots report something: what no step drives never has a robot. */
export function readingsOfRoles<Device extends Reports>(
  document: ProgramDocument,
  devices: readonly Device[],
): readonly RoleReadings<Device>[] {
  const driven = new Set(Object.values(document.steps).map((step) => roleOfStep(step)));
  return [DEFAULT_ROLE, ...Object.keys(document.roles).filter((each) => each !== DEFAULT_ROLE)]
    .filter((role) => driven.has(role))
    .map((role) => ({ role, readings: reportedBy(robotsFor(document.roles[role], devices)) }))
    .filter(({ readings }) => readings.length > 0);
}
