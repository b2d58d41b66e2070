import { expect, test } from "vitest";
import { floorMark, type FloorPlan, type MapZone } from "./floor";

const plan: FloorPlan = {
  version: 7,
  width: 1,
  height: 1,
  resolution_m: 1,
  origin: { x: 0, y: 0 },
  places: [],
  cells: new Uint8Array(1),
};
const zone: MapZone = {
  id: "z",
  name: "Aisle",
  rule: "keep_out",
  points: [
    [0, 0],
    [1, 0],
    [1, 1],
  ],
  speed_m_s: null,
};

test("routes are planned anew on another map and round other zones to keep out of, for nothing else", () => {
  const marks = [
    plan,
    { ...plan, version: 8 },
    { ...plan, zones: [zone] },
    {
      ...plan,
      zones: [
        {
          ...zone,
          points: [
            [0, 0],
            [1, 0],
            [1, 2],
          ] as const,
        },
      ],
    },
  ].map(floorMark);
  expect(marks.slice(0, 2)).toEqual(["7", "8"]);
  expect(new Set(marks).size).toBe(4);
  expect(floorMark({ ...plan, zones: [{ ...zone, name: "Other" }] })).toBe(marks[2]);
  expect(floorMark({ ...plan, zones: [{ ...zone, rule: "slow", speed_m_s: 0.3 }] })).toBe("7");
  expect(floorMark(null)).toBeUndefined();
});
