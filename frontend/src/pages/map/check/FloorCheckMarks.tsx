/** The findings of a floor check on the map: their numbers where they are, and how wide the chosen one's way is. */
import type { FloorFinding } from "@/api/types";
import { toPixels, type Point } from "@/map/plane/projection";
import styles from "./check.module.css";
import { isError, keyOf, metres } from "./findingWords";
import type { FloorCheckView } from "./useFloorCheckView";

const RADIUS = 11;

export function FloorCheckMarks({ view }: { view: FloorCheckView }) {
  const { check, chosen } = view;
  if (!check) return null;
  return (
    <g aria-hidden="true" className={styles.marks}>
      {chosen ? <Width finding={chosen} /> : null}
      {check.findings.map((finding, index) => (
        <Mark key={keyOf(finding)} finding={finding} number={index + 1} isChosen={finding === chosen} />
      ))}
    </g>
  );
}

function Mark({ finding, number, isChosen }: { finding: FloorFinding; number: number; isChosen: boolean }) {
  const { x, y } = toPixels([finding.x, finding.y]);
  return (
    <g transform={`translate(${x} ${y})`} data-grave={isError(finding)} className={styles.mark}>
      {isChosen ? <circle r={RADIUS + 6} className={styles.ring} /> : null}
      <circle r={RADIUS} />
      <text textAnchor="middle" dominantBaseline="central">
        {number}
      </text>
    </g>
  );
}

/** A line between what stands on either side, with how far that is. */
function Width({ finding: { sides, width_m } }: { finding: FloorFinding }) {
  const [from, to] = sides as readonly Point[];
  if (!from || !to || width_m === null) return null;
  const [a, b] = [toPixels(from), toPixels(to)];
  return (
    <g className={styles.width}>
      <line x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
      <circle cx={a.x} cy={a.y} r={4} />
      <circle cx={b.x} cy={b.y} r={4} />
      <text x={(a.x + b.x) / 2 + RADIUS * 2} y={(a.y + b.y) / 2 + 24}>
        {metres(width_m)}
      </text>
    </g>
  );
}
