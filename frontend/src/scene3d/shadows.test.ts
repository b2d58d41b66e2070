import { describe, expect, test } from "vitest";
import { type Point, prismOfObstacle, prismsOf, shadowOf } from "./shadows";
import type { SceneDevice } from "./types";

function area(shape: readonly Point[]): number {
  return shape.reduce((sum, [x, y], index) => {
    const [nextX, nextY] = shape[(index + 1) % shape.length] ?? [0, 0];
    return sum + (x * nextY - nextX * y) / 2;
  }, 0);
}

const at = (x: number, y: number, theta = 0): SceneDevice => ({
  id: "m",
  name: "M",
  kind: "machine",
  device_class: "",
  location: { x, y, theta },
  size: { x: 2, y: 1, z: 1 },
  radius_m: 0,
});

describe("shadowOf", () => {
  test("a box's shadow is its own floor drawn out away from the sun, to the north-east", () => {
    const [prism] = prismsOf(at(10, 5), [{ at: [0, 0.5, 0], box: [2, 1, 1], color: "" }]);
    const shape = shadowOf(prism ?? expect.fail());
    expect(shape).toHaveLength(6);
    expect(Math.min(...shape.map(([x]) => x))).toBeCloseTo(9);
    expect(Math.max(...shape.map(([x]) => x))).toBeCloseTo(11.375);
    expect(Math.max(...shape.map(([, y]) => y))).toBeCloseTo(6);
    expect(area(shape)).toBeCloseTo(2 + 0.375 * 1 + 0.5 * 2);
  });

  test("what hangs above the floor throws it beside itself", () => {
    const [prism] = prismsOf(at(0, 0), [{ at: [0, 2, 0], box: [1, 0.2, 1], color: "" }]);
    expect(Math.min(...shadowOf(prism ?? expect.fail()).map(([x]) => x))).toBeCloseTo(-0.5 + 1.9 * 0.375);
  });

  test("a machine that is turned throws a turned one", () => {
    const [prism] = prismsOf(at(0, 0, Math.PI / 2), [{ at: [1, 0.5, 0], box: [2, 1, 1], color: "" }]);
    const ys = (prism ?? expect.fail()).corners.map(([, y]) => y);
    expect(Math.min(...ys)).toBeCloseTo(0);
    expect(Math.max(...ys)).toBeCloseTo(2);
  });

  test("shapes run the same way round, so that where two lie over each other it is no darker", () => {
    const barrel = shadowOf(prismOfObstacle({ x: 3, y: 3, size_m: 0.5 }));
    expect(area(barrel)).toBeGreaterThan(0);
    const [prism] = prismsOf(at(1, 2, -2), [{ at: [0, 0.2, 0], can: { radius: 1, height: 0.4 }, color: "" }]);
    expect(area(shadowOf(prism ?? expect.fail()))).toBeGreaterThan(0);
  });

  test("lines on the floor throw none", () => {
    expect(prismsOf(at(0, 0), [{ at: [0, 0.012, 0], box: [2, 0.01, 0.05], color: "" }])).toEqual([]);
  });
});
