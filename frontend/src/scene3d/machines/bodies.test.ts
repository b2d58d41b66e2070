import { describe, expect, test } from "vitest";
import { mergeSolids } from "../solids";
import { DETAILS } from "@/map/devices/MachineBody";
import { BODIES, bodyOf } from "./bodies";
import type { Palette } from "../palette";

const SIZE = { x: 2, y: 1, z: 0.9 };
const PALETTE = new Proxy({}, { get: () => "#888888" }) as Palette;

describe("bodyOf", () => {
  test.each([...Object.keys(BODIES), "kiln", "constructor"])(
    "a machine of class %s stands on the floor within its size",
    (name) => {
      const { solids, glowing } = bodyOf(name, SIZE, PALETTE);
      const merged = mergeSolids([...solids, ...glowing]);
      merged.computeBoundingBox();
      const { min, max } = merged.boundingBox ?? expect.fail("nothing was drawn");
      expect(min.y).toBeGreaterThanOrEqual(-1e-6);
      expect(max.x - min.x).toBeLessThanOrEqual(SIZE.x + 0.1);
      expect(max.z - min.z).toBeLessThanOrEqual(SIZE.y + 0.1);
    },
  );

  test("a class that has a body here has one on the map, and the other way round", () => {
    expect(Object.keys(BODIES).sort()).toEqual(Object.keys(DETAILS).sort());
  });

  test("a class without a model is a box as high as the machine", () => {
    const merged = mergeSolids(bodyOf("kiln", SIZE, PALETTE).solids);
    merged.computeBoundingBox();
    expect(merged.boundingBox?.max.y).toBeCloseTo(SIZE.z);
  });
});
