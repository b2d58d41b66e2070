/** Where a program uses a device, a place, a variable or a function: the steps that name it. */
import { type ProgramDocument, type Step } from "@/program/document/document";
import { operatedRole, roleOfStep } from "@/program/operation";
import { namesGivenBy } from "./scopes";

export type UsedKind = "device" | "place" | "zone" | "variable" | "function";

export interface Used {
  readonly kind: UsedKind;
  /** An id; of variables and parameters the name. */
  readonly id: string;
}

/** The steps that name it, in no order. A robot is named by the steps of the role that it is bound to. */
export function usesOf(document: ProgramDocument, used: Used): string[] {
  return Object.entries(document.steps)
    .filter(([, step]) => names(document, step, used))
    .map(([id]) => id);
}

/** The names of all variables and parameters that steps set or read. */
export function variablesOf(document: ProgramDocument): string[] {
  const found = new Set(Object.values(document.parameters).map(({ name }) => name));
  for (const step of Object.values(document.steps)) {
    for (const name of namesGivenBy(step)) found.add(name);
    look(step.params, (key, value) => {
      if (key === "param" && typeof value === "string") found.add(value.split(".")[0] ?? value);
      return false;
    });
  }
  return [...found].sort();
}

/** The roles or zones that a step names, the role that it has without saying so among them. */
export function idsNamedBy(step: Step, key: "role" | "zone"): ReadonlySet<string> {
  const { args, ...params } = step.params;
  const usual = key === "role" ? roleOfStep(step) : null;
  const found = new Set(usual === null ? [] : [usual]);
  look([params, Object.values(args ?? {})], (name, value) => {
    if (name === key && typeof value === "string" && value) found.add(value);
    return false;
  });
  return found;
}

function names(document: ProgramDocument, step: Step, { kind, id }: Used): boolean {
  if (kind === "function") return step.kind === "call" && step.params.function === id;
  if (kind === "zone") return idsNamedBy(step, kind).has(id);
  if (kind === "variable") return namesGivenBy(step).includes(id) || reads(step.params, id);
  if (kind === "device" && boundTo(document, step, id)) return true;
  return look(step.params, (key, value) => (key === kind && value === id) || isReadingOf(key, value, id));
}

function boundTo(document: ProgramDocument, step: Step, device: string): boolean {
  const role = roleOfStep(step) ?? operatedRole(step.params.device);
  return role !== null && document.roles[role]?.device === device;
}

function reads(params: unknown, name: string): boolean {
  return look(params, (key, value) => {
    return key === "param" && (value === name || (typeof value === "string" && value.startsWith(`${name}.`)));
  });
}

/** A reading is written as a list of the device and the property. */
function isReadingOf(key: string, value: unknown, device: string): boolean {
  return key === "property" && Array.isArray(value) && value[0] === device;
}

/** Whether something inside says yes. */
function look(value: unknown, yes: (key: string, value: unknown) => boolean): boolean {
  if (typeof value !== "object" || value === null) return false;
  return Object.entries(value).some(([key, inner]) => yes(key, inner) || look(inner, yes));
}
