import { expect, test } from "vitest";
import { outlinesOf, scan } from "./rays";
import type { SceneDevice, SceneMap } from "@/scene3d/types";

/** A room of 10 by 6 m, its walls one cell of 0.5 m thick. */
const [WIDTH, HEIGHT, SIDE] = [20, 12, 0.5];
const cells = Array.from({ length: WIDTH * HEIGHT }, (_, at) => {
  const [column, row] = [at % WIDTH, Math.floor(at / WIDTH)];
  return column === 0 || row === 0 || column === WIDTH - 1 || row === HEIGHT - 1 ? 100 : 0;
});
const room = {
  width: WIDTH,
  height: HEIGHT,
  resolution_m: SIDE,
  origin: { x: -1, y: 2 },
  cells,
  places: [],
} as unknown as SceneMap;
const device = (x: number, y: number, theta: number) =>
  ({ location: { x, y, theta }, size: { x: 2, y: 1, z: 1 } }) as unknown as SceneDevice;
const rounded = (far: readonly number[]) => far.map((each) => Math.round(each * 1000) / 1000);

test("rays end at the walls, anticlockwise from where the robot looks", () => {
  // The middle of the room is at 4, 5; its walls begin 4.5 m to the sides and 2.5 m up and down.
  expect(rounded(scan(room, [4, 5, 0], [], [], 4))).toEqual([4.5, 2.5, 4.5, 2.5]);
  expect(rounded(scan(room, [3, 5, Math.PI / 2], [], [], 4))).toEqual([2.5, 3.5, 2.5, 5.5]);
});

test("what is out of range is not seen", () => {
  const open = { ...room, cells: cells.map(() => 0) } as unknown as SceneMap;
  expect(scan(open, [4, 5, 0], [], [], 8)).toEqual(Array(8).fill(Infinity));
});

test("machines are seen as they stand, turned", () => {
  const along = outlinesOf([device(6, 5, 0)]);
  const across = outlinesOf([device(6, 5, Math.PI / 2)]);
  expect(rounded(scan(room, [4, 5, 0], along, [], 4))[0]).toBe(1);
  expect(rounded(scan(room, [4, 5, 0], across, [], 4))[0]).toBe(1.5);
});

test("other robots are seen where they are, and not behind oneself twice", () => {
  const seen = rounded(scan(room, [4, 5, 0], [], [{ x: 6, y: 5, radius_m: 0.2 }], 4));
  expect(seen).toEqual([1.8, 2.5, 4.5, 2.5]);
});
