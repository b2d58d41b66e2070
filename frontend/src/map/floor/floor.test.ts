import { expect, test } from "vitest";
import { fitViewport } from "../plane/projection";
import {
  cellAt,
  cellBoxToPixels,
  floorMark,
  knownBox,
  leastZoom,
  mergeCells,
  planBox,
  wallBoxes,
  type FloorPlan,
  type MapZone,
} from "./floor";

const plan: FloorPlan = {
  version: 1,
  width: 4,
  height: 3,
  resolution_m: 1,
  origin: { x: 0, y: -3 },
  places: [],
  cells: Uint8Array.from([0, 0, 100, 255, 0, 0, 100, 255, 0, 0, 0, 255]),
};

test("equal runs of neighbouring rows become one box", () => {
  expect(mergeCells(plan, (cell) => cell === 100)).toEqual([{ column: 2, row: 0, columns: 1, rows: 2 }]);
  expect(mergeCells(plan, (cell) => cell === 0)).toEqual([
    { column: 0, row: 0, columns: 2, rows: 2 },
    { column: 0, row: 2, columns: 3, rows: 1 },
  ]);
});

test("the bottom row stands lowest on the screen", () => {
  const box = cellBoxToPixels(plan, { column: 0, row: 0, columns: 1, rows: 1 });
  expect(box).toEqual({ left: 0, right: 46, top: 92, bottom: 138 });
});

test("unknown cells at the edge are not part of the known box", () => {
  expect(knownBox(plan).right).toBe(138);
  expect(knownBox(plan)).toBe(knownBox(plan));
});

test("a large map is seen as a whole, and farther away; a small one no farther than before", () => {
  const hall = (width: number, height: number) => ({ ...plan, width, height, cells: new Uint8Array(width * height) });
  expect([leastZoom(null), leastZoom(plan), leastZoom(hall(20, 14))]).toEqual([0.2, 0.2, 0.2]);
  for (const [width, height] of [
    [200, 14],
    [20, 90],
    [1000, 1000],
  ] as const) {
    const whole = fitViewport(planBox(hall(width, height)), 800, 600, { left: 36, top: 36, right: 24, bottom: 24 });
    expect(leastZoom(hall(width, height))).toBeLessThan(0.5 * whole.zoom);
  }
});

test("a point off the map is unknown", () => {
  expect(cellAt(plan, [2.5, -2.5])).toBe(100);
  expect(cellAt(plan, [9, 9])).toBe(255);
});

test("walls are looked for once for as long as the cells stay the same", () => {
  expect(wallBoxes(plan)).toEqual([{ left: 92, right: 138, top: 46, bottom: 138 }]);
  expect(wallBoxes({ ...plan, version: 2 })).toBe(wallBoxes(plan));
});

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
  robots: null,
  heading_deg: null,
};

test("routes are planned anew on another map and for other zones that lead robots elsewhere, for nothing else", () => {
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
  expect(marks.slice(0, 2)).toEqual(["1", "8"]);
  expect(floorMark({ ...plan, tag: '"hall-1-2"' })).not.toBe(floorMark({ ...plan, tag: '"hall-1-1"' }));
  expect(new Set(marks).size).toBe(4);
  expect(floorMark({ ...plan, zones: [{ ...zone, name: "Other" }] })).toBe(marks[2]);
  expect(floorMark({ ...plan, zones: [{ ...zone, rule: "slow", speed_m_s: 0.3 }] })).toBe("1");
  const ways = [0, 90].map((heading_deg) => floorMark({ ...plan, zones: [{ ...zone, rule: "one_way", heading_deg }] }));
  ways.push(floorMark({ ...plan, zones: [{ ...zone, rule: "preferred" }] }));
  ways.push(floorMark({ ...plan, zones: [{ ...zone, rule: "release" }] }));
  expect(new Set([...marks, ...ways]).size).toBe(8);
  expect(floorMark(null)).toBeUndefined();
});
