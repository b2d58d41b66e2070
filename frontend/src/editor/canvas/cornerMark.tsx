/** The badge on a step's corner: what state the step is in, told by its shape; middle at 0, 0. */
import type { ReactNode } from "react";
import { OctagonMark, TickMark } from "@/map/StatusMark";
import type { Chip } from "../scene/chips";
import classes from "./stage.module.css";
import type { StepState } from "./stepState";

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
