/** A frame around the steps of a loop or a Try, in the state of its head. */
import type { CSSProperties } from "react";
import type { Frame } from "../scene/frames";
import { isLoop } from "../kinds";
import { cornerMark, type OtherPerson, type StepState } from "./stepState";
import classes from "./stage.module.css";

/** How far the outline of a selected frame stands off. */
const GAP = 4;

export interface FrameShapeProps {
  frame: Frame;
  state: StepState;
  selected: boolean;
  problem: "error" | "warning" | null;
  other: OtherPerson | null;
}

export function FrameShape({ frame, state, selected, problem, other }: FrameShapeProps) {
  const { box, kind } = frame;
  const radius = kind === "try" ? 20 : 12;
  const mark = cornerMark(problem, state);
  const around = selected ? "var(--brand)" : (other?.colour ?? null);
  return (
    <g className={classes.frame} data-state={state ?? undefined} data-problem={problem ?? undefined}>
      <rect x={box.left} y={box.top} width={box.right - box.left} height={box.bottom - box.top} rx={radius} />
      {around ? (
        <rect
          className={classes.frameAround}
          style={{ "--around": around } as CSSProperties}
          x={box.left - GAP}
          y={box.top - GAP}
          width={box.right - box.left + 2 * GAP}
          height={box.bottom - box.top + 2 * GAP}
          rx={radius + GAP}
        />
      ) : null}
      {isLoop(kind) ? <LoopArrow x={box.right - 30} y={box.bottom} /> : null}
      {mark ? <g transform={`translate(${box.right - 3} ${box.top + 3})`}>{mark}</g> : null}
      {other ? <Flag other={other} x={box.right + GAP} y={box.top - GAP} /> : null}
    </g>
  );
}

/** The border that goes back: what stands inside is done again. */
function LoopArrow({ x, y }: { x: number; y: number }) {
  return <path className={classes.loop} d="M5 -5.5 -1 0 5 5.5" transform={`translate(${x} ${y})`} />;
}

function Flag({ other, x, y }: { other: OtherPerson; x: number; y: number }) {
  const width = other.initials.length * 8 + 10;
  return (
    <g transform={`translate(${x - width} ${y - 17})`}>
      <rect className={classes.frameFlag} width={width} height={16} rx={4} style={{ fill: other.colour }} />
      <text x={width / 2} y={12} className={classes.frameInitials}>
        {other.initials}
      </text>
    </g>
  );
}
