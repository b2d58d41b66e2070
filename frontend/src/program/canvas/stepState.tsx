/** How a step fares in a run, and who else has it selected. */
import type { ReactNode } from "react";
import { OctagonMark, TickMark } from "@/map/devices/StatusMark";
import { markOf } from "../painting/marks";
import type { StepState } from "../painting/looks";
import type { Chip } from "../scene/chips";
import classes from "./stage.module.css";

export type { ComparedState, OtherPerson, StepState } from "../painting/looks";

export function cornerMark(problem: Chip["problem"], state: StepState): ReactNode {
  const mark = markOf(problem, state);
  if (mark === "failed") return <OctagonMark />;
  if (mark === "done") return <TickMark colour="var(--done)" />;
  if (mark === "running")
    return (
      <g fill="none" strokeWidth={3}>
        <circle r={6.5} fill="var(--panel)" stroke="var(--busy-soft)" />
        <circle r={6.5} stroke="var(--busy)" strokeDasharray="26 41" className={classes.turning} />
      </g>
    );
  return null;
}
