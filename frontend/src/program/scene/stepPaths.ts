/** Which paths a program drives, so that their routes can be asked for and drawn. */
import { type Position, type Place, type ProgramDocument, type Step, textOf } from "../document/document";
import { isCatch } from "../document/catches";
import { isRobot } from "@/map/devices/device";
import { type PixelPoint, simplified } from "@/map/plane/paths";
import { type Point, toMetres } from "@/map/plane/projection";
import { ancestors, type ProgramTree } from "../document/tree";
import { isPoint } from "../document/wellFormed";
import { operatedRole } from "../operation";
import { type Spot, spotOf, type Surroundings } from "../surroundings";
import { Standing } from "./standing";

export interface StepPath {
  readonly step: string;
  readonly from: Spot;
  readonly to: Spot;
  /** Equal for paths that have the same route. */
  readonly key: string;
  /** The bends that somebody drew, metres; null where the server finds the path. */
  readonly drawn: readonly Point[] | null;
}

export interface RouteShape {
  readonly step: string;
  readonly points: readonly PixelPoint[];
  /** Drawn before the server has answered. */
  readonly guessed: boolean;
}

/** A path's answer in metres; undefined while it is not known, null where there is none. */
export type RouteLookup = (key: string) => readonly (readonly [number, number])[] | null | undefined;

/** One path for each Pick-and-Drop and each Move whose ends are known, in reading order. */
export function pathsOf(document: ProgramDocument, tree: ProgramTree, surroundings: Surroundings): StepPath[] {
  const stepPaths: StepPath[] = [];
  const standing = new Standing(document);
  for (const id of tree.reading) {
    const step = document.steps[id];
    if (!step) continue;
    standing.begin(id);
    const scope = functionOf(document, id);
    if (operatedRole(step.params.device) !== null) continue;
    const role = `${scope ?? ""}/${textOf(step.params.role, "robot")}`;
    const from =
      startOf(step, document, surroundings, scope) ?? standing.get(role) ?? homeOf(step, document, surroundings);
    const to = endOf(step, document, surroundings, scope);
    if (from && to && (step.kind === "pick_and_drop" || step.kind === "move"))
      stepPaths.push({ step: id, from, to, key: keyOfPath(from, to), drawn: drawnRoute(step) });
    if (to && !isInCatch(document, id)) standing.set(role, to);
  }
  return stepPaths;
}

/** What is done when something fails is no part of the usual path. */
function isInCatch(document: ProgramDocument, id: string): boolean {
  return [id, ...ancestors(document, id)].some((each) => isCatch(document.steps[each]?.place?.[1]));
}

/** The function that a step belongs to, if it stands in one's body. */
export function functionOf(document: ProgramDocument, id: string): string | null {
  const top = ancestors(document, id).at(-1);
  return top && top in document.functions ? top : null;
}

/** Where the robot must stand when the step begins. */
export function startOf(
  step: Step,
  document: ProgramDocument,
  surroundings: Surroundings,
  scope: string | null,
): Spot | null {
  if (step.kind === "pick_and_drop") return spotOf(step.params.source, surroundings, document, scope);
  if (step.kind === "pick" || step.kind === "drop") return spotOf(step.params.at, surroundings, document, scope);
  return step.kind === "operate" ? spotOf(step.params.device, surroundings, document, scope) : null;
}

/** Where the step ends. */
export function endOf(
  step: Step,
  document: ProgramDocument,
  surroundings: Surroundings,
  scope: string | null,
): Spot | null {
  if (step.kind === "pick_and_drop") return spotOf(step.params.target, surroundings, document, scope);
  if (step.kind === "move") return spotOf(step.params.to, surroundings, document, scope);
  return startOf(step, document, surroundings, scope);
}

/** A Move with nothing before it starts where the robot of its role stands, if it is one known robot. */
function homeOf(step: Step, document: ProgramDocument, surroundings: Surroundings): Spot | null {
  const role = document.roles[textOf(step.params.role, "robot")];
  const robot = role?.device ? surroundings.devices.get(role.device) : undefined;
  if (step.kind !== "move" || !robot || !isRobot(robot)) return null;
  const point: [number, number] = [Math.round(robot.location.x * 2) / 2, Math.round(robot.location.y * 2) / 2];
  return spotOf({ point }, surroundings, document, null);
}

/** Equal for paths between the same places as they stand now. */
export function keyOfPath(from: Spot, to: Spot): string {
  return JSON.stringify([from.place, toMetres(from.at), to.place, toMetres(to.at)]);
}

/** The two ends of a path as the server takes them. */
export function endsOfWay(key: string): { from: Place; to: Place } {
  const [from, , to] = JSON.parse(key) as [Place, unknown, Place, unknown];
  return { from, to };
}

/** The bends that somebody drew; null for the automatic path. */
export function drawnRoute(step: Step | undefined): readonly Position[] | null {
  const route = step?.params.route;
  if (!Array.isArray(route) || route.length === 0) return null;
  return route.every(isPoint) ? route : null;
}

/** The bends of a path as it is planned; the middle of a straight one, so that there is one to drag. */
export function plannedBends(points: readonly PixelPoint[]): Position[] {
  const bends = simplified(points).slice(1, -1).map(toMetres);
  const [first, last] = [points[0], points.at(-1)];
  if (bends.length > 0 || !first || !last) return bends;
  return [toMetres({ x: (first.x + last.x) / 2, y: (first.y + last.y) / 2 })];
}
