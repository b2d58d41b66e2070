/** How far somebody is with the demo, by what they have really done. Pure. */
import type { Program, RunSummary, User } from "@/api/types";
import { nameOf } from "../people";

export interface DemoStep {
  readonly key: "look" | "draw" | "simulate" | "run";
  readonly done: boolean;
}

interface Known {
  readonly user: User;
  readonly programs: readonly Program[];
  readonly runs: readonly RunSummary[];
  readonly lookedAround: boolean;
  readonly simulated: boolean;
}

/** The program that this person last drew a Pick-and-Drop in, if any. */
export function ownProgram(user: User, programs: readonly Program[]): Program | undefined {
  return programs
    .filter((each) => each.edited_by?.id === user.id && each.kinds.includes("pick_and_drop"))
    .sort((a, b) => b.edited_at.localeCompare(a.edited_at))[0];
}

export function demoSteps({ user, programs, runs, lookedAround, simulated }: Known): DemoStep[] {
  return [
    { key: "look", done: lookedAround },
    { key: "draw", done: ownProgram(user, programs) !== undefined },
    { key: "simulate", done: simulated },
    { key: "run", done: runs.some((run) => nameOf(run.started_by) === user.name) },
  ];
}
