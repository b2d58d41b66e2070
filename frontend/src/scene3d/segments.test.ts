import { describe, expect, test } from "vitest";
import { FloorLines } from "./segments";

function pieces(lines: FloorLines): number[][] {
  const { geometry } = lines;
  const [start, end] = [geometry.getAttribute("instanceStart"), geometry.getAttribute("instanceEnd")];
  return Array.from({ length: geometry.instanceCount }, (_, index) =>
    [start.getX(index), start.getZ(index), end.getX(index), end.getZ(index)].map((each) => each + 0),
  );
}

describe("FloorLines", () => {
  test("lines are pieces from point to point, with y of the map away from who looks", () => {
    const lines = new FloorLines(0.04);
    lines.write([
      [
        [0, 0],
        [1, 2],
        [4, 6],
      ],
      [[9, 9]],
      [
        [5, 5],
        [6, 5],
      ],
    ]);
    expect(pieces(lines)).toEqual([
      [0, 0, 1, -2],
      [1, -2, 4, -6],
      [5, -5, 6, -5],
    ]);
    expect(lines.geometry.getAttribute("instanceStart").getY(0)).toBeCloseTo(0.04);
    const along = lines.geometry.getAttribute("instanceDistanceEnd");
    expect([0, 1, 2].map((index) => along.getX(index))).toEqual(
      [Math.hypot(1, 2), Math.hypot(1, 2) + 5, 1].map(Math.fround),
    );
  });

  test("fewer and far more lines than before take their place", () => {
    const lines = new FloorLines(0);
    const many = Array.from({ length: 3000 }, (_, index) => [index, 0] as const);
    lines.write([many]);
    expect(pieces(lines)).toHaveLength(2999);
    expect(pieces(lines).at(-1)).toEqual([2998, 0, 2999, 0]);
    lines.write([]);
    expect(pieces(lines)).toEqual([]);
  });
});
