import { expect, test } from "vitest";
import { nearestLeg, pushed, withCorner, withoutCorner } from "./corners";
import { nameOfKeys } from "./keys";
import { plannedBends } from "./routes";
import { portsOf, snap } from "./snapping";
import { viewFrom, zoomFor } from "./views";

const NOWHERE = { ports: [], centres: [] };

test("a chip near a machine's port stands at it, before all else", () => {
  const ports = portsOf({ left: 0, right: 100, top: 0, bottom: 60 });
  expect(ports).toContainEqual({ x: 50, y: 0 });
  expect(snap({ x: 60, y: 15 }, { ports, centres: [{ x: 61, y: 200 }] }, 1)).toEqual({
    at: { x: 50, y: 0 },
    guides: [],
  });
});

test("24 pixels are pixels of the screen, whatever the zoom", () => {
  const ports = [{ x: 0, y: 0 }];
  expect(snap({ x: 20, y: 0 }, { ports, centres: [] }, 1).at).toEqual({ x: 0, y: 0 });
  expect(snap({ x: 20, y: 0 }, { ports, centres: [] }, 2).at).toEqual({ x: 23, y: 0 });
});

test("in line with another chip it shows the line; the other axis keeps to the grid", () => {
  const other = { x: 100, y: 300 };
  expect(snap({ x: 95, y: 40 }, { ports: [], centres: [other] }, 1)).toEqual({
    at: { x: 100, y: 46 },
    guides: [{ from: other, to: { x: 100, y: 46 } }],
  });
});

test("elsewhere it stands on the grid of half a metre", () => {
  expect(snap({ x: 30, y: 60 }, NOWHERE, 1)).toEqual({ at: { x: 23, y: 69 }, guides: [] });
});

test("corners are pushed, added and taken away one at a time", () => {
  const square = [
    [0, 0],
    [1, 0],
    [1, 1],
  ] as const;
  expect(pushed(square, 1, [0.1, -0.2])[1]).toEqual([1.1, -0.2]);
  expect(withCorner(square, 1, [0.5, 0])).toEqual([
    [0, 0],
    [0.5, 0],
    [1, 0],
    [1, 1],
  ]);
  expect(withoutCorner(square, 0)).toEqual([
    [1, 0],
    [1, 1],
  ]);
});

test("a way that is dragged bends on the leg under the pointer", () => {
  const way = [
    { x: 0, y: 0 },
    { x: 100, y: 0 },
    { x: 100, y: 100 },
  ];
  expect([nearestLeg(way, { x: 40, y: 5 }), nearestLeg(way, { x: 95, y: 60 })]).toEqual([0, 1]);
});

test("the bends of a planned way begin a drawn one; a straight way gives one in its middle", () => {
  const planned = plannedBends([
    { x: 0, y: 0 },
    { x: 46, y: 0 },
    { x: 92, y: 0 },
    { x: 92, y: 92 },
  ]);
  expect(planned).toEqual([[2, 0]]);
  expect(
    plannedBends([
      { x: 0, y: 0 },
      { x: 92, y: 0 },
    ]),
  ).toEqual([[1, 0]]);
});

test("keys are named as the commands write them", () => {
  const held = { ctrlKey: false, metaKey: false, shiftKey: false, altKey: false };
  expect(nameOfKeys({ ...held, key: "g", ctrlKey: true, shiftKey: true })).toBe("Ctrl+Shift+G");
  expect(nameOfKeys({ ...held, key: "ArrowUp", metaKey: true })).toBe("Ctrl+ArrowUp");
  expect(nameOfKeys({ ...held, key: "a" })).toBe("A");
});

test("a followed view shows as much of the map; nonsense is not followed", () => {
  expect(zoomFor([0, 0, 20], 920)).toBe(1);
  expect(zoomFor([0, 0, 0.1], 920)).toBe(3);
  expect(viewFrom([1, 2, 10])).toEqual([1, 2, 10]);
  for (const value of [null, [1, 2], [1, 2, 0], [1, "2", 3], [1, 2, Number.NaN]]) expect(viewFrom(value)).toBeNull();
});
