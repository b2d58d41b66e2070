/** A picture of the constructs that is painted in slices, and shown moved and scaled until the next one is done. */
import type { Box, Viewport } from "@/map/plane/projection";
import { paintChip } from "./chipPainter";
import { detailAt } from "../scene/detail";
import type { ChipPiece, LinePiece, Pieces } from "../scene/pieces";
import { paintLine } from "./linePainter";
import type { Brush, PaintedLooks } from "./looks";
import type { Palette } from "@/map/plane/palette";

/** All that a picture shows; another object is another picture. */
export interface Content {
  readonly pieces: Pieces;
  readonly looks: PaintedLooks;
  /** What elements show instead, by their pieces' ids. */
  readonly without: ReadonlySet<string>;
  readonly palette: Palette;
  readonly count?: number;
}

/** What is painted of a view, in order; the work of each is in the units below. */
export type Job = Iterator<number, void>;

/** About 40 microseconds of a middling processor each: one construct with its words is one unit. */
const UNITS = {
  full: { chip: 1, hull: 0.6, route: 0.4, frame: 0.4, link: 0.2 },
  icon: { chip: 0.5, hull: 0.6, route: 0.4, frame: 0.3, link: 0.15 },
  dot: { chip: 0.15, hull: 0.6, route: 0.2, frame: 0.15, link: 0.08 },
} as const;

/** Paint what of the content lies in a box of the drawing plane; yields the units of each piece that was painted. */
export function* paintPieces(brush: Brush, content: Content, seen: Box): Generator<number, void> {
  const units = UNITS[brush.detail];
  for (const piece of piecesIn(content, seen)) {
    if ("chip" in piece) paintChip(brush, piece.chip);
    else paintLine(brush, piece);
    yield units[kindOf(piece)];
  }
}

/** How much work a picture of this part is. */
export function unitsOf(content: Content, seen: Box, zoom: number): number {
  const units = UNITS[detailAt(zoom)];
  return piecesIn(content, seen).reduce((sum, piece) => sum + units[kindOf(piece)], 0);
}

function piecesIn({ pieces, without }: Content, seen: Box): (LinePiece | ChipPiece)[] {
  return [...pieces.lines.within(seen), ...pieces.chips.within(seen)].filter(({ id }) => !without.has(id));
}

function kindOf(piece: LinePiece | ChipPiece): keyof (typeof UNITS)["full"] {
  if ("chip" in piece) return "chip";
  if ("hull" in piece) return "hull";
  if ("route" in piece) return "route";
  return "frame" in piece ? "frame" : "link";
}

/** Do so many units of a job; true once it is done. */
export function work(job: Job, units: number): boolean {
  for (let left = units; left > 0;) {
    const step = job.next();
    if (step.done) return true;
    left -= step.value;
  }
  return false;
}

/** Whether a picture of one view shows another one as it is: the same size, and its margin not used up. */
export function covers(picture: Viewport, view: Viewport, margin: number): boolean {
  const [dx, dy] = [view.x - picture.x, view.y - picture.y];
  return picture.zoom === view.zoom && Math.abs(dx) <= margin && Math.abs(dy) <= margin;
}
