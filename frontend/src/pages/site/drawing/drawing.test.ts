import { expect, test } from "vitest";
import type { CellMap } from "@/map/floor/rosFiles";
import { firstReading, isTooFine, mapFromDrawing, sizeOf, skippedOf, type Drawing } from "./drawing";

const ROOM: Drawing = {
  metres: 0.001,
  layers: [
    { name: "WALLS", hidden: false, lines: [[0, 0, 4000, 0, 4000, 3000, 0, 3000, 0, 0]] },
    { name: "AXES", hidden: true, lines: [[0, 1500, 4000, 1500]] },
  ],
  skipped: {},
};
const reading = { ...firstReading(ROOM), cell: 0.1 };

function at({ width, resolution_m: side, origin, cells }: CellMap, x: number, y: number): number | undefined {
  return cells[Math.floor((y - origin.y) / side) * width + Math.floor((x - origin.x) / side)];
}

test("blocks that are left out, in which walls may be, are told apart from what is no line", () => {
  const skipped = { XREF: 1, INSERT: 2, TEXT: 4, HATCH: 8, FAR: 16 };
  expect(skippedOf({ ...ROOM, skipped })).toEqual({ blocks: 3, far: 16, others: 12 });
  expect(skippedOf(ROOM)).toEqual({ blocks: 0, far: 0, others: 0 });
});

test("what is hidden in the drawing is not chosen at first, and the unit is the drawing's", () => {
  expect(reading.layers).toEqual(["WALLS"]);
  expect(sizeOf(ROOM, reading)).toEqual({ width: 4, height: 3 });
});

test("chosen lines become walls of the thickness, in the drawing's own coordinates", () => {
  const map = mapFromDrawing(ROOM, { ...reading, thickness: 0.3 });
  if (!map) throw new Error("no map");
  expect([at(map, 2, 0), at(map, 2, 0.12), at(map, 2, 0.35), at(map, 2, 1.5)]).toEqual([100, 100, 0, 0]);
  expect(at(map, -0.3, -0.3)).toBe(0);
  const both = mapFromDrawing(ROOM, { ...reading, layers: ["WALLS", "AXES"] });
  expect(both && at(both, 2, 1.52)).toBe(100);
});

test("walls without thickness have no gap, whatever their direction", () => {
  const lines = [[0, 0, 3.1, 1.3, 4, 4.2, 0.7, 2.9, 0, 0]];
  const slanted: Drawing = { metres: 1, layers: [{ name: "0", hidden: false, lines }], skipped: {} };
  const map = mapFromDrawing(slanted, { ...firstReading(slanted), thickness: 0, outsideUnknown: true });
  expect(map && [at(map, 2, 2), at(map, 3.8, 0.3)]).toEqual([0, 255]);
});

test("what lies outside of closed walls may be unknown", () => {
  const map = mapFromDrawing(ROOM, { ...reading, outsideUnknown: true });
  expect(map && [at(map, -0.3, -0.3), at(map, 2, 1.5)]).toEqual([255, 0]);
});

test("without a unit or a layer there is no map, nor with too many cells", () => {
  expect(firstReading({ ...ROOM, metres: null }).metres).toBe(0);
  expect(mapFromDrawing(ROOM, { ...reading, metres: 0 })).toBeNull();
  expect(mapFromDrawing(ROOM, { ...reading, layers: [] })).toBeNull();
  const inMetres = { ...reading, metres: 1 };
  expect(isTooFine(ROOM, inMetres)).toBe(true);
  expect(mapFromDrawing(ROOM, inMetres)).toBeNull();
});

test("there is no map of square kilometres, however large its cells are", () => {
  const wide: Drawing = { metres: 1, layers: [{ name: "0", hidden: false, lines: [[0, 0, 2000, 1500]] }], skipped: {} };
  const coarse = { ...firstReading(wide), cell: 1 };
  expect(isTooFine(wide, coarse)).toBe(false);
  expect(mapFromDrawing(wide, coarse)).toBeNull();
  expect(mapFromDrawing(wide, { ...coarse, metres: 0.3 })?.width).toBe(602);
});

test("a drawing in coordinates of a country's survey begins at zero", () => {
  const far: Drawing = {
    metres: 1,
    layers: [{ name: "0", hidden: false, lines: [[3_456_000, 5_789_000, 3_456_010, 5_789_000]] }],
    skipped: {},
  };
  const map = mapFromDrawing(far, firstReading(far));
  expect(map?.origin).toEqual({ x: 0, y: 0 });
  expect(map && map.width * map.resolution_m).toBeCloseTo(11.1, 0);
});
