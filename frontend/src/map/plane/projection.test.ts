import { expect, test } from "vitest";
import { boxAround, fitViewport, toMetres, toPixels } from "./projection";

test("y points up on the map and down on the screen", () => {
  expect(toPixels([2, -3])).toEqual({ x: 92, y: 138 });
  expect(toMetres({ x: 92, y: 138 })).toEqual([2, -3]);
});

test("metres are kept to the centimetre and never as minus zero", () => {
  expect(toMetres({ x: 0.1, y: 0 })).toEqual([0, 0]);
  expect(Object.is(toMetres({ x: 0, y: 0 })[1], 0)).toBe(true);
});

test("the box around nothing is null", () => {
  expect(boxAround([])).toBeNull();
});

test("a fitted viewport shows the box in the middle of the free part", () => {
  const view = fitViewport(
    { left: 0, top: 0, right: 100, bottom: 50 },
    400,
    300,
    { left: 100, top: 0, right: 0, bottom: 100 },
    9,
  );
  expect(view.zoom).toBe(3);
  expect(view.x).toBe(100);
  expect(view.y).toBe(25);
});
