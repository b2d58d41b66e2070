/** Outlines of zones as they are drawn and moved: points in metres, to the centimetre, never off the map; pure. */
import { toPixels, type Point } from "@/map/plane/projection";
import { onMap, type Extent } from "../../devices/placement";

export type Outline = readonly Point[];
export const FEWEST_CORNERS = 3;
/** How near (m) to the first corner a click closes the outline. */
export const CLOSES_M = 0.3;
/** A drag that is shorter (m) is a click. */
export const CLICK_M = 0.15;

export function rectangle([x1, y1]: Point, [x2, y2]: Point): Outline {
  const [left, right] = [Math.min(x1, x2), Math.max(x1, x2)];
  const [bottom, top] = [Math.min(y1, y2), Math.max(y1, y2)];
  return [
    [left, bottom],
    [right, bottom],
    [right, top],
    [left, top],
  ];
}

/** A square of 2 m for who draws by keyboard, cut off where the map ends. */
export function squareAt([x, y]: Point, map: Extent): Outline {
  return rectangle(onMap([x - 1, y - 1], map), onMap([x + 1, y + 1], map));
}

/** The outline moved as a whole, as far as all of it stays on the map. */
export function shifted(points: Outline, [dx, dy]: Point, map: Extent): Outline {
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  const right = map.origin.x + map.width * map.resolution_m;
  const top = map.origin.y + map.height * map.resolution_m;
  const by: Point = [
    Math.min(right - Math.max(...xs), Math.max(map.origin.x - Math.min(...xs), dx)),
    Math.min(top - Math.max(...ys), Math.max(map.origin.y - Math.min(...ys), dy)),
  ];
  return points.map(([x, y]) => onMap([x + by[0], y + by[1]], map));
}

export const withMoved = (points: Outline, at: number, to: Point): Outline =>
  points.map((point, index) => (index === at ? to : point));

export const withCorner = (points: Outline, at: number, corner: Point): Outline => [
  ...points.slice(0, at),
  corner,
  ...points.slice(at),
];

/** The same where it has no corner to spare. */
export const withoutCorner = (points: Outline, at: number): Outline =>
  points.length > FEWEST_CORNERS ? points.filter((_, index) => index !== at) : points;

/** The middle of the side that begins at a corner. */
export function middleOf(points: Outline, at: number): Point {
  const [a, b] = [points[at] ?? [0, 0], points[(at + 1) % points.length] ?? [0, 0]];
  return [Math.round((a[0] + b[0]) * 50) / 100, Math.round((a[1] + b[1]) * 50) / 100];
}

export const isNear = (a: Point, b: Point, reach: number): boolean => Math.hypot(a[0] - b[0], a[1] - b[1]) <= reach;

export const isSameOutline = (a: Outline, b: Outline): boolean =>
  a.length === b.length && a.every(([x, y], index) => x === b[index]?.[0] && y === b[index]?.[1]);

/** Square metres, by the shoelace formula. */
export function areaOf(points: Outline): number {
  const sum = points.reduce((total, [x, y], index) => {
    const [nextX, nextY] = points[(index + 1) % points.length] ?? [0, 0];
    return total + x * nextY - nextX * y;
  }, 0);
  return Math.abs(sum) / 2;
}

/** Whether a point lies in an outline: a ray from it to the right crosses the sides an odd number of times. */
export function holds(points: Outline, [x, y]: Point): boolean {
  const crossed = points.filter(([x1, y1], index) => {
    const [x2, y2] = points[(index + 1) % points.length] ?? [0, 0];
    return y1 > y !== y2 > y && x < x1 + ((y - y1) * (x2 - x1)) / (y2 - y1);
  });
  return crossed.length % 2 === 1;
}

/** An SVG path on the drawing plane. */
export function pathOf(points: Outline, closed: boolean): string {
  const drawn = points.map(toPixels).map(({ x, y }) => `${String(x)} ${String(y)}`);
  return `M${drawn.join("L")}${closed ? "Z" : ""}`;
}
