/** The dotted line from a step's dot to the pointer while a step is being joined. */
import { useStore, type ConnectionLineComponentProps } from "@xyflow/react";
import { use } from "react";
import { joinTarget } from "@/program/canvas/snapping";
import { decideJoin } from "./connection";
import classes from "../canvas/gestures.module.css";
import { START_ID } from "@/program/canvas/buildNodes";
import { ProgramContext } from "../state/context";

export function JoinLine({ fromX, fromY, toX, toY, fromNode }: ConnectionLineComponentProps) {
  const { sentence, refused, snapped } = useJoin(fromNode.id, toX, toY);
  return (
    <g>
      <path
        d={`M${fromX} ${fromY}L${toX} ${toY}`}
        fill="none"
        stroke="var(--logic)"
        strokeWidth={1.8}
        strokeDasharray="2 4"
        strokeLinecap="round"
      />
      <circle cx={toX} cy={toY} r={snapped ? 12 : 5} fill="var(--logic)" opacity={snapped ? 0.3 : 1} />
      <text className={classes.sentence} data-refused={refused || undefined} x={toX + 16} y={toY - 12}>
        {sentence}
      </text>
    </g>
  );
}

/** What letting go here would mean, in words. */
function useJoin(from: string, x: number, y: number): { sentence: string; refused: boolean; snapped: boolean } {
  const open = use(ProgramContext);
  const zoom = useStore((state) => state.transform[2]);
  const to = open ? joinTarget(open.scene.chips, from, { x, y }, zoom) : null;
  const chip = to === null ? undefined : open?.scene.chips.get(to);
  if (!open || to === null || !chip)
    return { sentence: open?.t("gesture.join.drop") ?? "", refused: false, snapped: false };
  const decision = decideJoin(open.document, from, to);
  if ("refused" in decision) return { sentence: open.t(`refused.${decision.refused}`), refused: true, snapped: true };
  const step = `${chip.number} ${open.t(`kind.${chip.kind}`)}`.trim();
  const sentence = open.t(from === START_ID ? "gesture.join.first" : "gesture.join.then", { step });
  return { sentence, refused: false, snapped: true };
}
