/** How a step fares in a run, and who else has it selected. */
export type StepState = "planned" | "running" | "done" | "failed" | "skipped" | null;

/** Somebody else who has the step selected. */
export interface OtherPerson {
  readonly name: string;
  readonly initials: string;
  readonly colour: string;
}
