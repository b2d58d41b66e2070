import { expect, test } from "vitest";
import type { Device, SiteMap } from "@/api/types";
import { blocksOf, cutWall, depth, floorBoxes, lookOf, project, wallBlocks } from "./projection";

function device(id: string, x: number, y: number, more: Partial<Device> = {}): Device {
  const base = { id, kind: "machine", lifecycle: "approved", status: "idle", device_class: "oven" };
  const location = { x, y, z: 0, theta: 0 };
  return { ...base, location, size: { x: 2, y: 1, z: 1 }, ...more } as unknown as Device;
}

test("up is up, right is right and far is higher", () => {
  const [x, y] = project([0, 0, 0]);
  expect([x, y]).toEqual([0, -0]);
  expect(project([0, 0, 1])[1]).toBeLessThan(y);
  expect(project([1, 0, 0])[0]).toBeGreaterThan(x);
  expect(project([0, 1, 0])[1]).toBeLessThan(y);
});

test("a long wall is cut into pieces of at most 1.2 m that cover it", () => {
  expect(cutWall([0, 0, 3, 0.2])).toEqual([
    [0, 0, 1, 0.2],
    [1, 0, 2, 0.2],
    [2, 0, 3, 0.2],
  ]);
  expect(cutWall([0, 0, 0.2, 1])).toEqual([[0, 0, 0.2, 1]]);
});

test("what stands farther away is drawn first; only approved devices stand", () => {
  const walls = wallBlocks({ walls: [[0, 5, 1, 5.2]] } as unknown as SiteMap);
  const devices = [device("near", 0, 0), device("far", 0, 9), device("asks", 0, 3, { lifecycle: "pending" })];
  const blocks = blocksOf(walls, devices);
  expect(blocks.map((block) => block.key)).toEqual(["far", "wall 0", "near"]);
  const depths = blocks.map((block) => depth(block.box));
  expect(depths).toEqual([...depths].sort((a, b) => b - a));
});

test("a machine that is turned by a quarter stands the other way", () => {
  const [block] = blocksOf([], [device("a", 0, 0, { location: { x: 0, y: 0, z: 0, theta: Math.PI / 2 } })]);
  expect(block?.box).toEqual([-0.5, -1, 0.5, 1]);
});

test("known cells become floor, unknown ones do not", () => {
  const cells = new Uint8Array([0, 100, 255, 0, 0, 255]);
  const map = { width: 3, height: 2, resolution_m: 0.5, origin: { x: -1, y: 2, yaw: 0 }, cells } as unknown as SiteMap;
  expect(floorBoxes(map)).toEqual([[-1, 2, 0, 3]]);
});

test("readings and small movements do not change the look, a status and a real move do", () => {
  const before = device("a", 1, 1);
  expect(lookOf([{ ...before, properties: [], doing: "x" }])).toBe(lookOf([before]));
  expect(lookOf([device("a", 1.02, 1)])).toBe(lookOf([before]));
  expect(lookOf([device("a", 1.2, 1)])).not.toBe(lookOf([before]));
  expect(lookOf([device("a", 1, 1, { status: "busy" })])).not.toBe(lookOf([before]));
});
