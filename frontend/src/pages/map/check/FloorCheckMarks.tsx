/** The findings of a floor check on the map: their numbers where they are, and how wide the chosen one's way is. */
import type { Device, FloorFinding, FloorRemedy, SiteMap } from "@/api/types";
import { footprint } from "@/map/devices/device";
import type { PixelPoint } from "@/map/plane/paths";
import { toPixels, type Point } from "@/map/plane/projection";
import styles from "./check.module.css";
import { isError, keyOf, metres } from "./findingWords";
import { markPlaces } from "./markPlaces";
import type { FloorCheckView } from "./useFloorCheckView";

const RADIUS = 11;
const PLACE = { width: 34, height: 34 };

interface FloorCheckMarksProps {
  map: SiteMap;
  devices: readonly Device[];
  view: FloorCheckView;
}

export function FloorCheckMarks({ map, devices, view }: FloorCheckMarksProps) {
  const { check, chosen, ghost } = view;
  if (!check) return null;
  const wanted = check.findings.map(({ x, y }) => toPixels([x, y]));
  const places = markPlaces(wanted, RADIUS * 2 + 2);
  return (
    <g aria-hidden="true" className={styles.marks}>
      {chosen ? <Width finding={chosen} /> : null}
      {ghost ? <Ghost map={map} devices={devices} remedy={ghost} /> : null}
      {check.findings.map((finding, index) => (
        <Mark
          key={keyOf(finding)}
          at={places[index] ?? toPixels([finding.x, finding.y])}
          isGrave={isError(finding)}
          number={index + 1}
          isChosen={finding === chosen}
        />
      ))}
    </g>
  );
}

interface MarkProps {
  at: PixelPoint;
  isGrave: boolean;
  number: number;
  isChosen: boolean;
}

function Mark({ at, isGrave, number, isChosen }: MarkProps) {
  return (
    <g transform={`translate(${at.x} ${at.y})`} data-grave={isGrave} className={styles.mark}>
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

/** Where a place or machine would stand, and from where it comes. */
function Ghost({ map, devices, remedy }: { map: SiteMap; devices: readonly Device[]; remedy: FloorRemedy }) {
  const machine = devices.find(({ id }) => id === remedy.target);
  const stands = machine?.location ?? map.places.find(({ id }) => id === remedy.target);
  if (!stands) return null;
  const [from, to] = [toPixels([stands.x, stands.y]), toPixels([remedy.x, remedy.y])];
  const { width, height } = machine ? footprint(machine) : PLACE;
  return (
    <g className={styles.ghost} data-ghost={remedy.target}>
      <line x1={from.x} y1={from.y} x2={to.x} y2={to.y} />
      <rect x={to.x - width / 2} y={to.y - height / 2} width={width} height={height} rx={6} />
    </g>
  );
}
