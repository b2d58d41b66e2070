/** The whole drawing of a program as plain shapes: pure, so that every screen draws the same. */
import { isRobot } from "@/map/devices/device";
import { PIXELS_PER_METRE, toPixels, type Box } from "@/map/plane/projection";
import { pointAlong, pathLength, simplified, type PixelPoint } from "@/map/plane/paths";
import type { Compiled, ProgramDocument, Step } from "../document/document";
import { readTree, type ProgramTree } from "../document/tree";
import { buildChip, type Chip, findingsByStep, type Measure, type TagSide } from "./chips";
import { clearHeads, framesOf, type Frame } from "./frames";
import { boxAt, edgeTowards, elbow, grown, leastCovering, legBoxes, nearestOn, overlaps, union } from "./geometry";
import { hullsOf, type Hull } from "./hulls";
import { isFramed } from "../kinds";
import { separateLanes } from "./lanes";
import { linksOf, type Link, wordBox } from "./links";
import { SpatialIndex } from "./spatialIndex";
import { functionOf, pathsOf, type RouteLookup, type RouteShape, type StepPath } from "./stepPaths";
import { deviceBox, type Surroundings } from "../surroundings";
import type { Speaker, Translate } from "../words/stepWords";

export interface Scene {
  readonly tree: ProgramTree;
  readonly start: PixelPoint;
  readonly chips: ReadonlyMap<string, Chip>;
  readonly routes: readonly RouteShape[];
  readonly links: readonly Link[];
  readonly frames: readonly Frame[];
  readonly hulls: readonly Hull[];
}

export interface SceneInput {
  readonly document: ProgramDocument;
  readonly compiled: Pick<Compiled, "numbers" | "diagnostics" | "added_moves"> | null;
  readonly surroundings: Surroundings;
  /** The part of the map that is known; null without a map. */
  readonly floor: Box | null;
  readonly routes: RouteLookup;
  /** Functions whose bodies are not drawn. */
  readonly collapsed: ReadonlySet<string>;
  readonly t: Translate;
  readonly measure: Measure;
}

/** Where the start is looked for first, metres; on a floor that does not hold it, as far inside its top left. */
const DEFAULT_START: readonly [number, number] = [1, -1];

/** How near a chip must lie to its route to be drawn on it. */
const ON_ROUTE = 26;

export function buildScene(input: SceneInput): Scene {
  const { document, surroundings, t } = input;
  const tree = readTree(document);
  const first = firstSpot(input.floor);
  const speaker: Speaker = { document, surroundings, t };
  const shown = [...tree.reading, ...tree.loose, ...commentsOf(document)].filter((id) => isShown(input, id));
  const isDrawn = new Set(shown);
  const stepPaths = pathsOf(document, tree, surroundings).filter((stepPath) => isDrawn.has(stepPath.step));
  const routes = shapeRoutes(stepPaths, input.routes);
  const chips = new Map<string, Chip>();
  const chipInput = { ...input, drafts: new Set(tree.drafts), findings: findingsByStep(input.compiled) };
  for (const id of shown) {
    const step = document.steps[id];
    if (step)
      chips.set(
        id,
        buildChip(
          id,
          step,
          chipPosition(step, standsInFrame(document, step) ? undefined : routes.get(id), first),
          chipInput,
          speaker,
        ),
      );
  }
  clearHeads(document, tree, chips);
  const frames = framesOf(document, tree, chips);
  const start = document.start_pos ? toPixels(document.start_pos) : freeStart(first, surroundings, chips);
  const links = linksOf({ document, tree, chips, frames, start, surroundings, t });
  placeTags(chips, routes, links);
  return {
    tree,
    start,
    chips,
    routes: [...routes.values()],
    links,
    frames: [...frames.values()],
    hulls: hullsOf(document, tree, chips, routes, surroundings, input.collapsed),
  };
}

function placeTags(chips: Map<string, Chip>, routes: ReadonlyMap<string, RouteShape>, links: readonly Link[]): void {
  const asked = [...chips.values()].filter((chip) => chip.shape === "diamond" && chip.condition);
  if (asked.length === 0) return;
  const lines = [
    ...[...routes.values()].flatMap((route) => legBoxes(route.points, 5)),
    ...links.flatMap((link) => (link.tone === "then" ? [] : legBoxes(link.points, 3))),
    ...links.flatMap((link) => wordBox(link) ?? []),
  ];
  const covers = new SpatialIndex<{ id?: string; box: Box }>([
    ...[...chips.values()].map(({ id, box }) => ({ id, box: grown(box, 3) })),
    ...lines.map((box) => ({ box })),
  ]);
  for (const chip of asked) chips.set(chip.id, { ...chip, tagSide: tagSide(chip, covers) });
}

/** Beside the diamond where the condition covers no chip, no line and no word. */
function tagSide(chip: Chip, covers: SpatialIndex<{ id?: string; box: Box }>): TagSide {
  const { x, y } = chip.at;
  const [beside, height] = [chip.width / 2 + 8 + chip.tagWidth / 2, 20];
  const at = (side: TagSide, dx: number, dy: number) => ({
    side,
    box: boxAt({ x: x + dx, y: y + dy }, chip.tagWidth, height),
  });
  const sides = [
    at("right", beside, 0),
    at("above", chip.tagWidth / 2 - 7, -34),
    at("below-left", -chip.tagWidth / 2 - 8, 38),
    at("below", 0, 38),
    at("left", -beside - 6, 0),
  ] as const;
  const around = sides.map(({ box }) => box).reduce(union);
  const near = covers.within(around).filter(({ id }) => id !== chip.id);
  return leastCovering(
    [...sides],
    near.map(({ box }) => box),
  ).side;
}

function firstSpot(floor: Box | null): PixelPoint {
  const usual = toPixels(DEFAULT_START);
  if (!floor || overlaps(floor, boxAt(usual, 0, 0))) return usual;
  return { x: floor.left + usual.x, y: floor.top + usual.y };
}

/** Along the top of the floor, where neither a machine nor a chip stands. */
function freeStart(first: PixelPoint, surroundings: Surroundings, chips: ReadonlyMap<string, Chip>): PixelPoint {
  const machines = [...surroundings.devices.values()].filter((device) => !isRobot(device)).map(deviceBox);
  const taken = [...machines.map((box) => grown(box, 14)), ...[...chips.values()].map((chip) => grown(chip.box, 8))];
  for (let metres = 0; metres < 19; metres += 0.5) {
    const at = { x: first.x + metres * PIXELS_PER_METRE, y: first.y };
    if (!taken.some((box) => overlaps(box, boxAt(at, 78, 30)))) return at;
  }
  return first;
}

function isShown(input: SceneInput, id: string): boolean {
  const scope = functionOf(input.document, id);
  return scope === null || !input.collapsed.has(scope);
}

/** Steps that drive the same path share its line. */
function shapeRoutes(stepPaths: readonly StepPath[], lookup: RouteLookup): Map<string, RouteShape> {
  const lineOf = (stepPath: StepPath) => stepPath.key + (stepPath.drawn ? JSON.stringify(stepPath.drawn) : "");
  const pathOf = (stepPath: StepPath) => stepPath.drawn ?? lookup(stepPath.key);
  const different = [...new Map(stepPaths.map((stepPath) => [lineOf(stepPath), stepPath])).values()];
  const lanes = separateLanes(
    different.map((stepPath) => routePoints(stepPath, pathOf(stepPath))),
    different.map((stepPath) => ({ start: stepPath.from.box !== null, end: stepPath.to.box !== null })),
  );
  const lines = new Map(different.map((stepPath, index) => [lineOf(stepPath), lanes[index] ?? []]));
  return new Map(
    stepPaths.map((stepPath) => {
      const points = lines.get(lineOf(stepPath)) ?? [];
      return [stepPath.step, { step: stepPath.step, points, guessed: !pathOf(stepPath) }];
    }),
  );
}

/** From edge to edge: the planned path between the outlines of what it joins. */
export function routePoints(
  stepPath: Pick<StepPath, "from" | "to">,
  path: readonly (readonly [number, number])[] | null | undefined,
): PixelPoint[] {
  const around = (spot: StepPath["from"]) =>
    spot.box ?? { left: spot.at.x - 4, right: spot.at.x + 4, top: spot.at.y - 4, bottom: spot.at.y + 4 };
  if (!path || path.length === 0) return elbow(around(stepPath.from), around(stepPath.to));
  const middle = path.map((point) => toPixels(point));
  const [first, last] = [middle[0], middle.at(-1)];
  if (!first || !last) return [];
  const head = stepPath.from.box ? [edgeTowards(stepPath.from.box, first)] : [];
  const tail = stepPath.to.box ? [edgeTowards(stepPath.to.box, last)] : [];
  return simplified([...head, ...middle, ...tail]);
}

/** Steps inside a frame stand beside its head, not on their routes. */
function standsInFrame(document: ProgramDocument, step: Step): boolean {
  const parent = step.pos && step.place?.[1] === "body" ? document.steps[step.place[0]] : undefined;
  return parent !== undefined && isFramed(parent.kind);
}

function commentsOf(document: ProgramDocument): string[] {
  return Object.keys(document.steps).filter((id) => document.steps[id]?.kind === "comment");
}

/** Where a step's chip is drawn: its own position, brought onto its route where that is near. */
function chipPosition(step: Step, route: RouteShape | undefined, first: PixelPoint): PixelPoint {
  const own = step.pos ? toPixels(step.pos) : null;
  if (!route) return own ?? first;
  if (!own) return pointAlong(route.points, pathLength(route.points) / 2) ?? first;
  const near = nearestOn(route.points, own);
  return near && near.off <= ON_ROUTE && !route.guessed ? near.at : own;
}

/** The box around a chip and, for a frame, around what stands in it. */
export function outerBox(scene: Pick<Scene, "chips" | "frames">, id: string): Box | null {
  return scene.frames.find((frame) => frame.id === id)?.box ?? scene.chips.get(id)?.box ?? null;
}
