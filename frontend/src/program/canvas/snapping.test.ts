import { expect, test } from "vitest";
import { portsOf, snap } from "./snapping";

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
