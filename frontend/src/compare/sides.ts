/** What is compared, as the address has it: a version's number, `draft` for what is drawn now, a run by its id. */
import type { RunSummary, Version } from "@/api/types";

export const DRAFT = "draft";
const RUN = "run:";

export function runSide(id: string): string {
  return RUN + id;
}

/** The version that a side stands for, `draft`, or null for a run that is not known or has none. */
export function versionOfSide(side: string, runs: readonly Pick<RunSummary, "id" | "version">[]): string | null {
  if (side === DRAFT || /^[1-9]\d{0,8}$/.test(side) || otherSide(side)) return side;
  const run = runs.find((each) => runSide(each.id) === side);
  return run?.version ? String(run.version) : null;
}

/** A program of another site from which this one was made, or that was made from it. */
export interface Relative {
  readonly id: string;
  readonly name: string;
  readonly site: string;
  /** Its newest version; 0 while it has none. */
  readonly newest: number;
}

/** A side that is of another program, such as another site's copy. */
export interface OtherSide {
  readonly program: string;
  /** A version's number, or `draft`. */
  readonly version: string;
}

export function otherSide(side: string): OtherSide | null {
  const [, program, version] = /^([0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12}):(draft|[1-9]\d{0,8})$/.exec(side) ?? [];
  return program && version ? { program, version } : null;
}

export function otherSideOf(program: string, version: number | typeof DRAFT): string {
  return `${program}:${version}`;
}

/** The two sides of an address; where it names none, the newest version and what is drawn now. */
export function sidesOf(address: URLSearchParams, newest: number | undefined): { old: string; new: string } {
  return { old: address.get("old") ?? (newest ? String(newest) : DRAFT), new: address.get("new") ?? DRAFT };
}

/** The address that compares two sides of a program. */
export function compareAddress(program: string, old: string, next: string): string {
  return `/programs/${program}/compare?${new URLSearchParams({ old, new: next }).toString()}`;
}

/** What to say of a version where it has no name of its own: why it was made. */
export function versionTitle(version: Pick<Version, "name" | "cause">, t: (key: string) => string): string {
  return version.name || t(version.cause ? `compare.cause.${version.cause}` : "compare.unnamed");
}

/** Whether both sides, as the server is asked for them, are one version: what is drawn now is none. */
export function isOneVersion([old, next]: readonly [string, string]): boolean {
  return old === next && !old.endsWith(DRAFT);
}
