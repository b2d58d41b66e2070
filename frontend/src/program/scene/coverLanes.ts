/** The lanes in which a robot covers a zone, as a preview: there and back along its longer side; pure, metres. */
import { ownEntry } from "@/design/ownEntry";
import type { Position, ProgramDocument, Step, Value, Zone } from "../document/document";
import { textOf } from "../document/document";

/** So many lanes are shown; more would be a grey area. */
const MOST_LANES = 300;
const USUAL_RADIUS_M = 0.18;
const LENGTHS_M: Readonly<Record<string, number>> = { M: 1, CentiM: 0.01, MilliM: 0.001, KiloM: 1000 };

export interface Lanes {
  readonly width: number;
  /** Each a line without a break, over one lane or several side by side. */
  readonly lines: readonly (readonly Position[])[];
}

interface Robot {
  readonly id: string;
  readonly kind: string;
  readonly radius_m?: number;
}

/** The lanes over the zone of a cover; null where it has none, or nobody knows how wide they are. */
export function lanesOf(step: Step | undefined, document: ProgramDocument, robots: readonly Robot[]): Lanes | null {
  const zone = step?.kind === "cover" ? document.zones[textOf(step.params.zone)] : undefined;
  const width = step && laneWidth(step, document, robots);
  return zone && width ? lanesOver(zone, width) : null;
}

/** As the step says it in metres, or as wide as its robot; null where it is worked out in the run. */
export function laneWidth(step: Step, document: ProgramDocument, robots: readonly Robot[]): number | null {
  const said = (step.params.lane ?? null) as Value;
  if (typeof said === "number") return said > 0 ? said : null;
  if (said !== null) return quantityOf(said);
  const bound = document.roles[textOf(step.params.role, "robot")]?.device;
  const fitting = robots.filter((each) => each.kind === "robot" && (!bound || each.id === bound));
  return (
    2 *
    Math.min(...fitting.map((each) => each.radius_m || USUAL_RADIUS_M), fitting.length > 0 ? Infinity : USUAL_RADIUS_M)
  );
}

function quantityOf(value: Value): number | null {
  if (typeof value !== "object" || value === null || !("quantity" in value)) return null;
  const [amount, unit] = value.quantity;
  const metres = amount * (ownEntry(LENGTHS_M, unit) ?? 0);
  return metres > 0 ? metres : null;
}

export function lanesOver(zone: Zone, widest: number): Lanes | null {
  const best = narrowest(zone.points);
  if (!best) return null;
  const { along, low, across } = best;
  const count = Math.max(1, Math.ceil(across / widest - 1e-9));
  if (count > MOST_LANES) return null;
  const width = across / count;
  const lines: Position[][] = [];
  let open: Position[] | null = null;
  for (let strip = 0; strip < count; strip += 1) {
    const at = low + (strip + 0.5) * width;
    const pieces = crossings(zone.points, along, at).map(([begin, end]) => {
      const inset = Math.min(width / 2, (end - begin) / 2);
      return [place(along, begin + inset, at), place(along, end - inset, at)] as const;
    });
    const [only, second] = pieces;
    if (only && !second && open) open.push(...(strip % 2 ? [only[1], only[0]] : only));
    else {
      const fresh = pieces.map(([begin, end]) => (strip % 2 ? [end, begin] : [begin, end]));
      lines.push(...fresh);
      open = fresh.length === 1 ? (fresh[0] ?? null) : null;
    }
  }
  return { width, lines };
}

/** The side along which a zone is narrowest, as a unit vector, and from where across it how far it goes. */
function narrowest(points: readonly Position[]): { along: Position; low: number; across: number } | null {
  let best: { along: Position; low: number; across: number; length: number } | null = null;
  points.forEach(([x, y], index) => {
    const [nextX, nextY] = points[(index + 1) % points.length] ?? [x, y];
    const length = Math.hypot(nextX - x, nextY - y);
    if (length < 1e-6) return;
    const along: Position = [(nextX - x) / length, (nextY - y) / length];
    const offsets = points.map((point) => offset(along, point));
    const low = Math.min(...offsets);
    const across = Math.round((Math.max(...offsets) - low) * 1e6) / 1e6;
    if (!best || across < best.across || (across === best.across && length > best.length))
      best = { along, low, across, length };
  });
  return best;
}

/** From where to where a line along the zone lies in it, by the even-odd rule. */
function crossings(points: readonly Position[], along: Position, at: number): readonly (readonly [number, number])[] {
  const cuts = points.flatMap((point, index) => {
    const next = points[(index + 1) % points.length] ?? point;
    const [here, there] = [offset(along, point), offset(along, next)];
    if (here > at === there > at) return [];
    const share = (at - here) / (there - here);
    return [reach(along, point) + share * (reach(along, next) - reach(along, point))];
  });
  cuts.sort((one, other) => one - other);
  return cuts.flatMap((cut, index) => (index % 2 ? [] : [[cut, cuts[index + 1] ?? cut] as const]));
}

function reach([ux, uy]: Position, [x, y]: Position): number {
  return x * ux + y * uy;
}

function offset([ux, uy]: Position, [x, y]: Position): number {
  return y * ux - x * uy;
}

function place([ux, uy]: Position, along: number, across: number): Position {
  return [along * ux - across * uy, along * uy + across * ux];
}

/** The zone in which a point lies; where several do, the smallest by its corners' order in the document. */
export function zoneAt(document: ProgramDocument, [x, y]: Position): string | null {
  const around = Object.entries(document.zones).find(
    ([, zone]) => Array.isArray(zone?.points) && crossings(zone.points, [1, 0], y).some(([a, b]) => a <= x && x <= b),
  );
  return around?.[0] ?? null;
}
