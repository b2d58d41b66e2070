import { expect, test } from "vitest";
import { differencePaths, sharedBox } from "./mapDifference";
import type { FloorPlan } from "./floor";

function plan(width: number, rows: number[][], x = 0, resolution_m = 1): FloorPlan {
  const cells = Uint8Array.from(rows.flat());
  return { version: 1, width, height: rows.length, resolution_m, origin: { x, y: 0 }, places: [], cells };
}

test("what one map has and the other has not is outlined in the map frame", () => {
  const before = plan(3, [[0, 0, 100]]);
  const after = plan(3, [[0, 100, 0]]);
  expect(differencePaths(before, after)).toEqual({
    wallsGained: "M46.00 -46.00H92.00V0.00H46.00Z",
    wallsLost: "M92.00 -46.00H138.00V0.00H92.00Z",
    floorGained: "M92.00 -46.00H138.00V0.00H92.00Z",
    floorLost: "M46.00 -46.00H92.00V0.00H46.00Z",
  });
});

test("maps with other cells and another corner are laid over each other by metres", () => {
  const before = plan(2, [[100, 0]]);
  const fine = plan(
    6,
    [
      [255, 255, 100, 100, 0, 0],
      [255, 255, 100, 100, 0, 0],
    ],
    -1,
    0.5,
  );
  expect(Object.values(differencePaths(before, fine))).toEqual(["", "", "", ""]);
  expect(sharedBox(before, fine)).toEqual({ left: 0, top: -46, right: 92, bottom: -0 });
});

test("what a smaller map does not reach is lost", () => {
  const { floorLost, floorGained } = differencePaths(plan(3, [[0, 0, 0]]), plan(1, [[0]]));
  expect([floorLost, floorGained]).toEqual(["M46.00 -46.00H138.00V0.00H46.00Z", ""]);
});
