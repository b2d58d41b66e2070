/** The similarity that lays points on others with the least squares (Umeyama 1991, in the plane). Pure. */
export type Point = readonly [number, number];

export interface Similarity {
  readonly scale: number;
  /** Radians anticlockwise. */
  readonly theta: number;
  readonly shift: Point;
}

export function transform({ scale, theta, shift }: Similarity, [x, y]: Point): Point {
  const [cos, sin] = [scale * Math.cos(theta), scale * Math.sin(theta)];
  return [cos * x - sin * y + shift[0], sin * x + cos * y + shift[1]];
}

export function inverse({ scale, theta, shift }: Similarity): Similarity {
  const turned = { scale: 1 / scale, theta: -theta, shift: [0, 0] } as const;
  const [x, y] = transform(turned, shift);
  return { ...turned, shift: [-x, -y] };
}

function middle(points: readonly Point[]): Point {
  const sum = points.reduce<Point>(([a, b], [x, y]) => [a + x, b + y], [0, 0]);
  return [sum[0] / points.length, sum[1] / points.length];
}

/** Turn, scale and shift `from` onto `to`, pair by pair; null where the points lie on each other. No mirror image. */
export function fit(from: readonly Point[], to: readonly Point[], keepScale: boolean): Similarity | null {
  const [a, b] = [middle(from), middle(to)];
  let [along, across, size, goal] = [0, 0, 0, 0];
  from.forEach(([px, py], index) => {
    const [qx, qy] = to[index] ?? [0, 0];
    const [x, y, u, v] = [px - a[0], py - a[1], qx - b[0], qy - b[1]];
    along += x * u + y * v;
    across += x * v - y * u;
    size += x * x + y * y;
    goal += u * u + v * v;
  });
  if (size < 1e-9 || goal < 1e-9 || Math.hypot(along, across) < 1e-9) return null;
  const turned = {
    scale: keepScale ? 1 : Math.hypot(along, across) / size,
    theta: Math.atan2(across, along),
    shift: [0, 0] as Point,
  };
  const [x, y] = transform(turned, a);
  return { ...turned, shift: [b[0] - x, b[1] - y] };
}

/** How far each point lies from its partner after the fit, and the root of their mean square. */
export function residuals(found: Similarity, from: readonly Point[], to: readonly Point[]) {
  const each = from.map((point, index) => {
    const [x, y] = transform(found, point);
    const [u, v] = to[index] ?? [0, 0];
    return Math.hypot(x - u, y - v);
  });
  return { each, all: Math.sqrt(each.reduce((sum, far) => sum + far * far, 0) / each.length) };
}
