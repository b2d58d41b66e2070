import { expect, test } from "vitest";
import { fit, inverse, residuals, transform, type Point, type Similarity } from "./similarity";

const FROM: readonly Point[] = [
  [0, 0],
  [10, 0],
  [2, 7],
];
const known: Similarity = { scale: 1.25, theta: 0.4, shift: [-3, 8] };
const far = ([a, b]: Point, [c, d]: Point) => Math.hypot(a - c, b - d);

test("three points that fit exactly give the similarity back", () => {
  const to = FROM.map((point) => transform(known, point));
  const found = fit(FROM, to, false);
  expect(found?.scale).toBeCloseTo(1.25);
  expect(found?.theta).toBeCloseTo(0.4);
  expect(found?.shift[0]).toBeCloseTo(-3);
  expect(found && residuals(found, FROM, to).all).toBeCloseTo(0);
});

test("no other similarity near by has smaller squares where points do not fit", () => {
  const noise: readonly Point[] = [
    [0.3, -0.2],
    [-0.1, 0.4],
    [0.2, 0.1],
  ];
  const to = FROM.map((point, index) => {
    const [x, y] = transform(known, point);
    return [x + (noise[index]?.[0] ?? 0), y + (noise[index]?.[1] ?? 0)] as const;
  });
  const found = fit(FROM, to, false);
  if (!found) throw new Error("nothing found");
  const least = residuals(found, FROM, to).all;
  expect(least).toBeGreaterThan(0.01);
  for (const step of [-0.01, 0.01]) {
    const others: Similarity[] = [
      { ...found, scale: found.scale + step },
      { ...found, theta: found.theta + step },
      { ...found, shift: [found.shift[0] + step, found.shift[1]] },
      { ...found, shift: [found.shift[0], found.shift[1] + step] },
    ];
    for (const other of others) expect(residuals(other, FROM, to).all).toBeGreaterThan(least);
  }
});

test("a scale that is kept is one, and what it misses is told point by point", () => {
  const to = FROM.map(([x, y]) => [2 * x, 2 * y] as const);
  const found = fit(FROM, to, true);
  expect(found?.scale).toBe(1);
  expect(found?.theta).toBeCloseTo(0);
  const { each, all } = residuals(found ?? known, FROM, to);
  expect(each).toHaveLength(3);
  expect(Math.max(...each)).toBeGreaterThan(all);
});

test("points on each other say nothing", () => {
  const one: readonly Point[] = [
    [1, 1],
    [1, 1],
    [1, 1],
  ];
  expect(fit(one, FROM, false)).toBeNull();
  expect(fit(FROM, one, false)).toBeNull();
});

test("the inverse leads back", () => {
  const back = inverse(known);
  for (const point of FROM) expect(far(transform(back, transform(known, point)), point)).toBeLessThan(1e-9);
});
