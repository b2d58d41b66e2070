/** The dotted line from a step's dot to the pointer while a step is being joined. */
import type { ConnectionLineComponentProps } from "@xyflow/react";

export function JoinLine({ fromX, fromY, toX, toY, toNode }: ConnectionLineComponentProps) {
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
      <circle cx={toX} cy={toY} r={toNode ? 12 : 5} fill="var(--logic)" opacity={toNode ? 0.3 : 1} />
    </g>
  );
}
