/** Boxes, edges and ways on the drawing plane. */
import type { Box } from "@/map/plane/projection";
import { distance, type PixelPoint } from "@/map/plane/paths";

export function boxAt(at: PixelPoint, width: number, height: number): Box {
  return { left: at.x - width / 2, right: at.x + width / 2, top: at.y - height / 2, bottom: at.y + height / 2 };
}

export function centre(box: Box): PixelPoint {
  return { x: (box.left + box.right) / 2, y: (box.top + box.bottom) / 2 };
}

export function grown(box: Box, by: number): Box {
  return { left: box.left - by, right: box.right + by, top: box.top - by, bottom: box.bottom + by };
}

export function union(one: Box, other: Box): Box {
  return {
    left: Math.min(one.left, other.left),
    right: Math.max(one.right, other.right),
    top: Math.min(one.top, other.top),
    bottom: Math.max(one.bottom, other.bottom),
  };
}

export function overlaps(one: Box, other: Box): boolean {
  return one.left < other.right && one.right > other.left && one.top < other.bottom && one.bottom > other.top;
}

/** The area that two boxes have in common. */
export function shared(one: Box, other: Box): number {
  const across = Math.min(one.right, other.right) - Math.max(one.left, other.left);
  const down = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
  return across > 0 && down > 0 ? across * down : 0;
}

/** The first of the candidates that covers nothing, or else the one that covers least. */
export function leastCovering<T extends { readonly box: Box }>(
  candidates: readonly [T, ...T[]],
  covers: readonly Box[],
): T {
  let [best] = candidates;
  let least = Infinity;
  for (const each of candidates) {
    const covered = covers.reduce((sum, cover) => sum + shared(each.box, cover), 0);
    if (covered < least) [best, least] = [each, covered];
    if (covered === 0) break;
  }
  return best;
}

/** The straight legs of a way as thin boxes. */
export function legBoxes(points: readonly PixelPoint[], by: number): Box[] {
  return points.slice(1).flatMap((b, index) => {
    const a = points[index];
    if (!a) return [];
    const [left, right] = [Math.min(a.x, b.x), Math.max(a.x, b.x)];
    const [top, bottom] = [Math.min(a.y, b.y), Math.max(a.y, b.y)];
    return [grown({ left, right, top, bottom }, by)];
  });
}

/** How far apart two boxes are; 0 where they touch. */
export function gap(one: Box, other: Box): number {
  const across = Math.max(0, other.left - one.right, one.left - other.right);
  const down = Math.max(0, other.top - one.bottom, one.top - other.bottom);
  return Math.hypot(across, down);
}

/** The point on the box's outline nearest to a point outside it. */
export function edgeTowards(box: Box, point: PixelPoint): PixelPoint {
  return {
    x: Math.min(box.right, Math.max(box.left, point.x)),
    y: Math.min(box.bottom, Math.max(box.top, point.y)),
  };
}

/** A way of at most three legs between two boxes, leaving and meeting them at right angles. */
export function elbow(from: Box, to: Box): PixelPoint[] {
  const [a, b] = [centre(from), centre(to)];
  const overlapX = Math.min(from.right, to.right) - Math.max(from.left, to.left);
  const overlapY = Math.min(from.bottom, to.bottom) - Math.max(from.top, to.top);
  if (overlapX > 12) {
    const x = (Math.min(from.right, to.right) + Math.max(from.left, to.left)) / 2;
    return a.y < b.y
      ? [
          { x, y: from.bottom },
          { x, y: to.top },
        ]
      : [
          { x, y: from.top },
          { x, y: to.bottom },
        ];
  }
  if (overlapY > 12) {
    const y = (Math.min(from.bottom, to.bottom) + Math.max(from.top, to.top)) / 2;
    return a.x < b.x
      ? [
          { x: from.right, y },
          { x: to.left, y },
        ]
      : [
          { x: from.left, y },
          { x: to.right, y },
        ];
  }
  const start = { x: a.x, y: a.y < b.y ? from.bottom : from.top };
  const end = { x: a.x < b.x ? to.left : to.right, y: b.y };
  return [start, { x: a.x, y: b.y }, end];
}

/** The same, but leaving at the left or right side first. */
export function elbowSideways(from: Box, to: Box): PixelPoint[] {
  const flipped = elbow(mirrored(from), mirrored(to));
  return flipped.map((point) => ({ x: point.y, y: point.x }));
}

function mirrored(box: Box): Box {
  return { left: box.top, right: box.bottom, top: box.left, bottom: box.right };
}

/** The point of a way nearest to `to`, and how far off it is. */
export function nearestOn(points: readonly PixelPoint[], to: PixelPoint): { at: PixelPoint; off: number } | null {
  let best: { at: PixelPoint; off: number } | null = null;
  for (let index = 1; index < points.length; index += 1) {
    const [a, b] = [points[index - 1], points[index]];
    if (!a || !b) continue;
    const at = nearestOnLeg(a, b, to);
    const off = distance(at, to);
    if (!best || off < best.off) best = { at, off };
  }
  return best;
}

function nearestOnLeg(a: PixelPoint, b: PixelPoint, to: PixelPoint): PixelPoint {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const square = dx * dx + dy * dy;
  const part = square === 0 ? 0 : Math.min(1, Math.max(0, ((to.x - a.x) * dx + (to.y - a.y) * dy) / square));
  return { x: a.x + dx * part, y: a.y + dy * part };
}
