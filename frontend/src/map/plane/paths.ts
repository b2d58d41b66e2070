/** A polyline as a drawn route: rounded corners, chevrons, its longest straight stretch. */

export interface PixelPoint {
  readonly x: number;
  readonly y: number;
}

const CORNER = 17.5;

/** SVG path with corners rounded by 0.38 m, or by half the shorter leg where there is less room. */
export function roundedPath(points: readonly PixelPoint[], radius = CORNER): string {
  const first = points[0];
  if (!first) return "";
  let path = `M${fixed(first)}`;
  for (let index = 1; index < points.length; index += 1) {
    const [before, at, after] = [points[index - 1], points[index], points[index + 1]];
    if (!before || !at) continue;
    if (!after) path += `L${fixed(at)}`;
    else {
      const bend = Math.min(radius, distance(before, at) / 2, distance(at, after) / 2);
      path += `L${fixed(towards(at, before, bend))}Q${fixed(at)} ${fixed(towards(at, after, bend))}`;
    }
  }
  return path;
}

/** The same for a closed outline given by its corners. */
export function roundedOutline(corners: readonly PixelPoint[], radius = 12): string {
  const [first, second] = [corners[0], corners[1]];
  if (!first || !second) return "";
  const seam = towards(first, second, distance(first, second) / 2);
  return `${roundedPath([seam, ...corners.slice(1), first, seam], radius)}Z`;
}

function fixed(point: PixelPoint): string {
  return `${Math.round(point.x * 10) / 10} ${Math.round(point.y * 10) / 10}`;
}

export function distance(a: PixelPoint, b: PixelPoint): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}

/** The point `step` pixels from `from` in the direction of `to`. */
export function towards(from: PixelPoint, to: PixelPoint, step: number): PixelPoint {
  const whole = distance(from, to);
  if (whole === 0) return from;
  return { x: from.x + ((to.x - from.x) * step) / whole, y: from.y + ((to.y - from.y) * step) / whole };
}

export function pathLength(points: readonly PixelPoint[]): number {
  return points.slice(1).reduce((sum, point, index) => sum + distance(points[index] ?? point, point), 0);
}

export interface OnPath extends PixelPoint {
  /** Degrees clockwise on the screen, 0 to the right. */
  readonly angle: number;
}

/** The point at `along` pixels from the start, and which way the route goes there. */
export function pointAlong(points: readonly PixelPoint[], along: number): OnPath | null {
  let left = along;
  for (let index = 1; index < points.length; index += 1) {
    const [a, b] = [points[index - 1], points[index]];
    if (!a || !b) return null;
    const leg = distance(a, b);
    if (leg > 0 && (left <= leg || index === points.length - 1))
      return { ...towards(a, b, Math.min(left, leg)), angle: angleOf(a, b) };
    left -= leg;
  }
  return null;
}

export function angleOf(a: PixelPoint, b: PixelPoint): number {
  return (Math.atan2(b.y - a.y, b.x - a.x) * 180) / Math.PI;
}

/** One every `every` pixels, none near the ends. */
export function chevrons(points: readonly PixelPoint[], every = 184): OnPath[] {
  const whole = pathLength(points);
  const found: OnPath[] = [];
  for (let along = every; along < whole - 60; along += every) {
    const at = pointAlong(points, along);
    if (at) found.push(at);
  }
  return found;
}

export interface Stretch {
  readonly a: PixelPoint;
  readonly b: PixelPoint;
  readonly length: number;
}

/** The straight legs, the longest first; horizontal ones count a fifth more, a chip lies better on them. */
export function stretches(points: readonly PixelPoint[]): Stretch[] {
  const legs = points.slice(1).flatMap((b, index) => {
    const a = points[index];
    return a ? [{ a, b, length: distance(a, b) }] : [];
  });
  const weight = (leg: Stretch) => leg.length * (Math.abs(leg.a.y - leg.b.y) < Math.abs(leg.a.x - leg.b.x) ? 1.2 : 1);
  return legs.sort((one, other) => weight(other) - weight(one));
}

/** Leave out points that lie on the straight line between their neighbours. */
export function simplified(points: readonly PixelPoint[]): PixelPoint[] {
  return points.filter((point, index) => {
    const [before, after] = [points[index - 1], points[index + 1]];
    if (!before || !after) return true;
    const cross = (point.x - before.x) * (after.y - before.y) - (point.y - before.y) * (after.x - before.x);
    return Math.abs(cross) > 0.5;
  });
}
