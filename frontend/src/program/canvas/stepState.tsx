/** How a step fares in a run, and who else has it selected. */
import type { ReactNode } from "react";
import { OctagonMark, TickMark } from "@/map/devices/StatusMark";
import type { Chip } from "../scene/chips";
import classes from "./stage.module.css";

/** What happened to a step between two documents that are compared. */
export type ComparedState = "added" | "removed" | "changed" | "moved" | "same";
export type StepState = "planned" | "running" | "done" | "failed" | "skipped" | ComparedState | null;

/** Somebody else who has the step selected. */
export interface OtherPerson {
  readonly name: string;
  readonly initials: string;
  readonly colour: string;
}

export function cornerMark(problem: Chip["problem"], state: StepState): ReactNode {
  if (state === "failed" || (state === null && problem === "error")) return <OctagonMark />;
  if (state === "done") return <TickMark colour="var(--done)" />;
  if (state === "running")
    return (
      <g fill="none" strokeWidth={3}>
        <circle r={6.5} fill="var(--panel)" stroke="var(--busy-soft)" />
        <circle r={6.5} stroke="var(--busy)" strokeDasharray="26 41" className={classes.turning} />
      </g>
    );
  return null;
}
