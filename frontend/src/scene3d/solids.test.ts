import { describe, expect, test } from "vitest";
import { mergeSolids } from "./solids";

describe("mergeSolids", () => {
  test("boxes and cans become one geometry where they stand, each vertex in its solid's colour", () => {
    const merged = mergeSolids([
      { at: [1, 0, 0], box: [2, 2, 2], color: "#ff0000" },
      { at: [10, 0, 0], can: { radius: 1, height: 4, sides: 8 }, color: "#0000ff" },
    ]);
    merged.computeBoundingBox();
    expect(merged.boundingBox?.min.toArray()).toEqual([0, -2, -1]);
    expect(merged.boundingBox?.max.x).toBeCloseTo(11);
    expect(merged.boundingBox?.max.y).toBeCloseTo(2);
    const [places, colors] = [merged.getAttribute("position"), merged.getAttribute("color")];
    expect(colors.count).toBe(places.count);
    for (let index = 0; index < places.count; index += 1) {
      const red = places.getX(index) < 5;
      expect([colors.getX(index), colors.getY(index), colors.getZ(index)]).toEqual(red ? [1, 0, 0] : [0, 0, 1]);
    }
  });

  test("a solid is turned about its own middle", () => {
    const merged = mergeSolids([
      { at: [0, 5, 0], turn: [Math.PI / 2, 0, 0], can: { radius: 0.1, height: 2 }, color: "#fff" },
    ]);
    merged.computeBoundingBox();
    expect(merged.boundingBox?.max.z).toBeCloseTo(1);
    expect(merged.boundingBox?.max.y).toBeCloseTo(5.1);
  });

  test("nothing is an empty geometry", () => {
    expect(mergeSolids([]).getAttribute("position")).toBeUndefined();
  });
});
