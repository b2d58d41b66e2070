import { expect, test } from "vitest";
import { drawn } from "../../mapEdit/cells/drawn";
import { machineEdges, reachAt, snapped, wallEdges, type Edge } from "./snapping";

/** Cells of 5 cm whose lower left corner is at -1.5, 2. */
const hall = { ...drawn("#####", "#...#", "#..??", "#####"), resolution_m: 0.05, origin: { x: -1.5, y: 2 } };
const close = (x: number, y: number) => [expect.closeTo(x, 9) as number, expect.closeTo(y, 9) as number];
const wall = (x: number, y: number, reach = 0.15) => snapped([x, y], wallEdges(hall, [x, y], reach), reach);

test("a point snaps to the border of the wall, not to the middle of a cell, and stays where it is along the wall", () => {
  expect(wall(-1.44, 2.083)).toEqual(close(-1.45, 2.083));
  expect(wall(-1.4, 2.055)).toEqual(close(-1.4, 2.05));
  expect(wall(-1.31, 2.12)).toEqual(close(-1.3, 2.12));
  expect(wall(-1.4, 2.148)).toEqual(close(-1.4, 2.15));
});

test("it snaps from within the wall, too", () => {
  expect(wall(-1.48, 2.12)).toEqual(close(-1.45, 2.12));
  expect(wall(-1.48, 2.01)).toEqual(close(-1.45, 2.05));
});

test("rows are counted from the bottom", () => {
  const lower = drawn("..", "#.");
  const upper = drawn("#.", "..");
  expect(wallEdges(lower, [1, 0.5], 0.2)).toContainEqual([[1, 0], [1, 1]]); // prettier-ignore
  expect(wallEdges(upper, [1, 1.5], 0.2)).toContainEqual([[1, 1], [1, 2]]); // prettier-ignore
  expect(snapped([1.1, 0.5], wallEdges(upper, [1.1, 0.5], 0.3), 0.3)).toEqual([1.1, 0.5]);
});

test("what is unknown and where the map ends is no edge", () => {
  expect(wallEdges(drawn("..?", ".??"), [1.5, 1], 9)).toEqual([]);
  expect(wallEdges(drawn("?#?"), [1.5, 0.5], 9)).toEqual([]);
  expect(wallEdges(drawn("..", ".."), [0, 0], 9)).toEqual([]);
});

test("only edges within reach are snapped to, and all of them are looked at", () => {
  const wide = drawn("#.........#");
  expect(snapped([1.3, 0.5], wallEdges(wide, [1.3, 0.5], 0.25), 0.25)).toEqual([1.3, 0.5]);
  expect(snapped([1.2, 0.5], wallEdges(wide, [1.2, 0.5], 0.25), 0.25)).toEqual([1, 0.5]);
  expect(snapped([6, 0.5], wallEdges(wide, [6, 0.5], 4.5), 4.5)).toEqual([10, 0.5]);
  expect(snapped([-50, 80], wallEdges(wide, [-50, 80], 0.25), 0.25)).toEqual([-50, 80]);
});

test("in a corner the nearer wall is snapped to, at a corner that stands out its tip", () => {
  const inside = drawn("#.", "##");
  expect(snapped([1.1, 1.05], wallEdges(inside, [1.1, 1.05], 0.3), 0.3)).toEqual([1.1, 1]);
  expect(snapped([1.05, 1.1], wallEdges(inside, [1.05, 1.1], 0.3), 0.3)).toEqual([1, 1.1]);
  const outside = drawn("..", "#.");
  expect(snapped([1.2, 1.2], wallEdges(outside, [1.2, 1.2], 0.5), 0.5)).toEqual([1, 1]);
});

const machine = (theta: number) => ({
  kind: "machine",
  location: { x: 20.9, y: -3.05, theta },
  size: { x: 3.1, y: 1.7 },
});
const atMachine = (x: number, y: number, theta: number): unknown =>
  snapped([x, y], machineEdges([machine(theta)]), 0.2);

test("a point snaps to the outline of a machine as it stands", () => {
  expect(atMachine(19.3, -3, 0)).toEqual(close(19.35, -3));
  expect(atMachine(20.1, -3, Math.PI / 2)).toEqual(close(20.05, -3));
  expect(atMachine(20.9 - 1.5 * Math.SQRT1_2, -3.05 - 1.5 * Math.SQRT1_2, Math.PI / 4)).toEqual(
    close(20.9 - 1.55 * Math.SQRT1_2, -3.05 - 1.55 * Math.SQRT1_2),
  );
});

test("robots, and machines that do not say how large they are, have no edges", () => {
  expect(machineEdges([{ ...machine(0), kind: "robot" }])).toEqual([]);
  expect(machineEdges([{ ...machine(0), size: null }])).toEqual([]);
});

test("the nearer of two edges wins; an edge without length is a point", () => {
  const edges: Edge[] = [
    [[0, 0], [0, 2]], // prettier-ignore
    [[0.2, 1], [0.2, 1]], // prettier-ignore
  ];
  expect(snapped([0.05, 1], edges, 1)).toEqual([0, 1]);
  expect(snapped([0.15, 1], edges, 1)).toEqual([0.2, 1]);
});

test("a pointer snaps as far as 12 pixels of the screen, and never less far than 15 cm", () => {
  expect(reachAt(4)).toBe(0.15);
  expect(reachAt(0.5)).toBeCloseTo(12 / 23);
});
