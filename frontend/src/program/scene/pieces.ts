/** The scene cut into what is painted and pressed one by one, in the order in which it lies over each other. Pure. */
import { boxAround, type Box } from "@/map/plane/projection";
import type { PixelPoint } from "@/map/plane/paths";
import type { Chip } from "./chips";
import type { Frame } from "./frames";
import { grown, nearestOn, union } from "./geometry";
import type { Hull } from "./hulls";
import { type Link, wordBox } from "./links";
import type { Scene } from "./scene";
import { SpatialIndex } from "./spatialIndex";
import type { RouteShape } from "./stepPaths";

/** A line that several steps drive, once. */
export interface SharedRoute {
  readonly points: RouteShape["points"];
  readonly steps: readonly RouteShape[];
}

export type LinePiece = { readonly id: string; readonly box: Box } & (
  | { readonly hull: Hull }
  | { readonly route: SharedRoute }
  | { readonly frame: Frame; readonly problem: Chip["problem"] }
  | { readonly link: Link }
);

export interface ChipPiece {
  readonly id: string;
  readonly box: Box;
  readonly chip: Chip;
}

export interface Pieces {
  readonly lines: SpatialIndex<LinePiece>;
  readonly chips: SpatialIndex<ChipPiece>;
}

/** Drawing pixels that a line's arrow, a chip's badge or a person's flag stands over the edge. */
const OVER_LINE = 12;
const OVER_CHIP = 24;

export function piecesOf(scene: Pick<Scene, "chips" | "routes" | "links" | "frames" | "hulls">): Pieces {
  return {
    lines: new SpatialIndex([
      ...scene.hulls.map((hull) => piece(`hull:${hull.functionId}`, hull.outlines.flat(), { hull })),
      ...sharedRoutes(scene.routes).map((route) => piece(routeId(route), route.points, { route })),
      // Inner frames lie on the frames around them.
      ...[...scene.frames].reverse().map((frame) => framePiece(frame, scene.chips.get(frame.id)?.problem ?? null)),
      ...scene.links.map(linkPiece),
    ]),
    chips: new SpatialIndex([...scene.chips.values()].map(chipPiece)),
  };
}

/** Apart: the constructs that stand on one of the boxes, which would cover them, and all else. */
export function splitOver(pieces: Pieces, boxes: readonly Box[]): { readonly below: Pieces; readonly over: Pieces } {
  const on = new Set(boxes.flatMap((box) => pieces.chips.within(box).filter(({ chip }) => touches(chip.box, box))));
  if (on.size === 0) return { below: pieces, over: NO_PIECES };
  const chips = (isOver: boolean) => new SpatialIndex(pieces.chips.items.filter((each) => on.has(each) === isOver));
  return { below: { lines: pieces.lines, chips: chips(false) }, over: { lines: NO_PIECES.lines, chips: chips(true) } };
}

const NO_PIECES: Pieces = { lines: new SpatialIndex([]), chips: new SpatialIndex([]) };

function linkId(link: Link): string {
  return `link:${link.id}`;
}

function routeId({ steps }: SharedRoute): string {
  return `route:${steps[0]?.step ?? ""}`;
}

function piece<Shape>(id: string, points: readonly PixelPoint[], shape: Shape) {
  return { id, box: grown(boxAround(points) ?? NOWHERE, OVER_LINE), ...shape };
}

const NOWHERE: Box = { left: 0, right: 0, top: 0, bottom: 0 };

function linkPiece(link: Link): LinePiece {
  const whole = piece(linkId(link), link.points, { link });
  const word = wordBox(link);
  return word ? { ...whole, box: union(whole.box, word) } : whole;
}

function framePiece(frame: Frame, problem: Chip["problem"]): LinePiece {
  return { id: `frame:${frame.id}`, box: grown(frame.box, 2 * OVER_LINE), frame, problem };
}

/** With the words of a condition beside it. */
function chipPiece(chip: Chip): ChipPiece {
  const tag = chip.shape === "diamond" ? chip.tagWidth : 0;
  const box = grown(chip.box, OVER_CHIP);
  return { id: chip.id, box: { ...box, left: box.left - tag, right: box.right + tag }, chip };
}

/** Steps that drive the same way share one line. */
function sharedRoutes(routes: readonly RouteShape[]): SharedRoute[] {
  const byLine = new Map<RouteShape["points"], RouteShape[]>();
  for (const route of routes) {
    const sharing = byLine.get(route.points) ?? [];
    sharing.push(route);
    byLine.set(route.points, sharing);
  }
  return [...byLine].map(([points, steps]) => ({ points, steps }));
}

/** The uppermost construct at a point of the drawing plane. */
export function chipAt({ chips }: Pieces, point: PixelPoint): Chip | null {
  const under = chips.within(grown(around(point), 1)).filter(({ chip }) => isInside(chip.box, point));
  return under.at(-1)?.chip ?? null;
}

/** The uppermost way or arrow whose line passes so near to a point, drawing pixels. */
export function lineAt({ lines }: Pieces, point: PixelPoint, reach: number): LinePiece | null {
  const near = lines.within(grown(around(point), reach)).filter((each) => {
    if ("route" in each && each.route.steps.every(({ guessed }) => guessed)) return false;
    const points = "link" in each ? each.link.points : "route" in each ? each.route.points : [];
    return (nearestOn(points, point)?.off ?? Infinity) <= reach || isOnWord(each, point);
  });
  return near.at(-1) ?? null;
}

function isOnWord(line: LinePiece, point: PixelPoint): boolean {
  const word = "link" in line ? wordBox(line.link) : null;
  return word !== null && isInside(word, point);
}

/** The constructs whose middle, or all of which, lies in a box. */
export function chipsIn({ chips }: Pieces, box: Box, touching: boolean): string[] {
  return chips
    .within(box)
    .filter(({ chip }) => (touching ? touches(chip.box, box) : contains(box, chip.box)))
    .map(({ id }) => id);
}

function around({ x, y }: PixelPoint): Box {
  return { left: x, right: x, top: y, bottom: y };
}

function isInside(box: Box, { x, y }: PixelPoint): boolean {
  return x >= box.left && x <= box.right && y >= box.top && y <= box.bottom;
}

function touches(one: Box, other: Box): boolean {
  return one.left <= other.right && one.right >= other.left && one.top <= other.bottom && one.bottom >= other.top;
}

function contains(outer: Box, inner: Box): boolean {
  return (
    inner.left >= outer.left && inner.right <= outer.right && inner.top >= outer.top && inner.bottom <= outer.bottom
  );
}
