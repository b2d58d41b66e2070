/** How a rehearsal is done, as its form has it, kept in this browser for each program. */
import { draftOf, entryOf, type FaultDraft } from "./faults";
import type { Given } from "./Parameters";

export const DRIVERS = ["physics", "kinematic"] as const;
export type Driver = (typeof DRIVERS)[number];
export const LARGEST_SEED = 2 ** 31 - 1;

export interface Conditions {
  readonly seed: number;
  readonly driver: Driver;
  readonly parameters: Given;
  readonly faults: readonly FaultDraft[];
}

/** As a rehearsal is done that nobody said more of. */
export const USUAL: Conditions = { seed: 0, driver: "physics", parameters: {}, faults: [] };

const keyOf = (program: string) => `vipo.rehearse.${program}`;

export function keepConditions(program: string, { faults, ...rest }: Conditions): void {
  localStorage.setItem(keyOf(program), JSON.stringify({ ...rest, faults: faults.map(entryOf) }));
}

/** What was said of this program's rehearsals last; the usual where that is nothing, or cannot be read. */
export function keptConditions(program: string): Conditions {
  try {
    return conditionsOf(JSON.parse(localStorage.getItem(keyOf(program)) ?? "null"));
  } catch {
    return USUAL;
  }
}

/** How a rehearsal was asked for, as a form has it. */
export function conditionsOf(asked: unknown): Conditions {
  if (typeof asked !== "object" || asked === null) return USUAL;
  const { seed, driver, parameters, faults } = asked as Readonly<Record<string, unknown>>;
  return {
    seed: isSeed(seed) ? seed : USUAL.seed,
    driver: DRIVERS.find((each) => each === driver) ?? USUAL.driver,
    parameters: typeof parameters === "object" && parameters !== null ? (parameters as Given) : {},
    faults: Array.isArray(faults) ? faults.flatMap((entry) => draftOf(entry) ?? []) : [],
  };
}

export const isSeed = (value: unknown): value is number =>
  typeof value === "number" && Number.isInteger(value) && value >= 0 && value <= LARGEST_SEED;
