/** What is compared, as the address has it: a version's number, `draft` for what is drawn now, a run by its id. */
import type { RunSummary, Version } from "@/api/types";

export const DRAFT = "draft";
const RUN = "run:";

export function runSide(id: string): string {
  return RUN + id;
}

/** The version that a side stands for, `draft`, or null for a run that is not known or has none. */
export function versionOfSide(side: string, runs: readonly Pick<RunSummary, "id" | "version">[]): string | null {
  if (side === DRAFT || /^[1-9]\d{0,8}$/.test(side)) return side;
  const run = runs.find((each) => runSide(each.id) === side);
  return run?.version ? String(run.version) : null;
}

/** The two sides of an address; where it names none, the newest version and what is drawn now. */
export function sidesOf(address: URLSearchParams, newest: number | undefined): { old: string; new: string } {
  return { old: address.get("old") ?? (newest ? String(newest) : DRAFT), new: address.get("new") ?? DRAFT };
}

/** The address that compares two sides of a program. */
export function compareAddress(program: string, old: string, next: string): string {
  return `/programs/${program}/compare?${new URLSearchParams({ old, new: next }).toString()}`;
}

/** The runs of each version, the newest first. */
export function runsByVersion(runs: readonly RunSummary[]): ReadonlyMap<number, readonly RunSummary[]> {
  const found = new Map<number, RunSummary[]>();
  for (const run of runs) {
    const number = run.version;
    if (number) found.set(number, [...(found.get(number) ?? []), run]);
  }
  return found;
}

/** What to say of a version where it has no name of its own: why it was made. */
export function versionTitle(version: Pick<Version, "name" | "cause">, t: (key: string) => string): string {
  return version.name || t(version.cause ? `compare.cause.${version.cause}` : "compare.unnamed");
}
