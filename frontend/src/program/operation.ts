/** Who carries out a step, and what there is to choose for an Operate: machines' methods, and robots' own. */
import { isRobot } from "@/map/devices/device";
import { type ProgramDocument, type Step, textOf } from "./document/document";
import { isDriving, STEP_KINDS } from "./kinds";
import type { Method, SiteDevice, Surroundings } from "./surroundings";

export const DEFAULT_ROLE = "robot";
/** Methods of robots that are steps of their own. */
export const ROBOT_STEPS = STEP_KINDS.flatMap((each) => (each.drives === "robot" && each.method ? [each.method] : []));
/** Methods of machines that are part of picking and dropping. */
const HANDING = ["dispense", "accept"];

/** The role of the program that an Operate speaks to; null where it speaks to a device or a place. */
export function operatedRole(device: unknown): string | null {
  if (typeof device !== "object" || device === null || !("role" in device)) return null;
  return textOf(device.role) || null;
}

/** The role whose robot carries out the step, or is given back by it; null where there is none. */
export function roleOfStep(step: Step | undefined): string | null {
  if (step?.kind === "operate") return operatedRole(step.params.device);
  return step && isDriving(step.kind) ? textOf(step.params.role, DEFAULT_ROLE) : null;
}

/** The parameter that gives a step to a role. */
export function givenToRole(step: Step | undefined, role: string): { name: string; value: unknown } {
  return step?.kind === "operate" ? { name: "device", value: { role } } : { name: "role", value: role };
}

/** Methods that a person may choose for an Operate. */
export function operable(device: Pick<SiteDevice, "kind" | "methods">): readonly Method[] {
  const others = isRobot(device) ? ROBOT_STEPS : HANDING;
  return device.methods.filter((method) => !others.includes(method.name));
}

/** The devices that may carry out an Operate: the one that is named, or all robots that may take the role. */
export function operated(device: unknown, document: ProgramDocument, surroundings: Surroundings): SiteDevice[] {
  const role = operatedRole(device);
  if (role === null) {
    const named = surroundings.devices.get(textOf((device as { device?: unknown } | null | undefined)?.device));
    return named ? [named] : [];
  }
  const bound = document.roles[role]?.device;
  const robots = [...surroundings.devices.values()].filter((each) => isRobot(each) && each.lifecycle !== "pending");
  return bound ? robots.filter((each) => each.id === bound) : robots;
}

/** What can be chosen of these devices; methods of the same name stand there once. */
export function choices(devices: readonly SiteDevice[]): Method[] {
  const found = new Map<string, Method>();
  for (const method of devices.flatMap(operable)) if (!found.has(method.name)) found.set(method.name, method);
  return [...found.values()];
}

/** The device of an Operate, where it is one, and the method as it or the first robot that has it describes it. */
export function methodOf(step: Step, surroundings: Surroundings, document: ProgramDocument) {
  const devices = operated(step.params.device, document, surroundings);
  const method = devices.flatMap((each) => each.methods).find((each) => each.name === step.params.method);
  return { device: operatedRole(step.params.device) === null ? devices[0] : undefined, devices, method };
}
