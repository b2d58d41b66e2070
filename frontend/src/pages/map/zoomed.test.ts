import { expect, test } from "vitest";
import { kept, NEAREST, showing, zoomedAt } from "./zoomed";

const FIT = { x: 10, y: 20, zoom: 0.5 };
const FRAME = { left: 0, top: 0, right: 1000, bottom: 500 };
const PANE = { width: 520, height: 290 };

test("the point that is zoomed at stays where it is", () => {
  const near = zoomedAt(FIT, FIT, 2, 110, 70);
  expect(near).toEqual({ zoom: 1, x: -90, y: -30 });
  const at = ({ x, y, zoom }: typeof FIT) => [(110 - x) / zoom, (70 - y) / zoom];
  expect(at(near ?? FIT)).toEqual(at(FIT));
});

test("farther than the whole is the whole, and there is a nearest", () => {
  expect(zoomedAt({ ...FIT, zoom: 0.6 }, FIT, 0.5, 0, 0)).toBeNull();
  expect(zoomedAt(FIT, FIT, 1e6, 0, 0)?.zoom).toBe(NEAREST);
  expect(zoomedAt({ ...FIT, zoom: 20 }, { ...FIT, zoom: 20 }, 2, 0, 0)).toBeNull();
});

test("a map that is moved stays in sight", () => {
  const view = { zoom: 1, x: -400, y: -100 };
  expect(kept(view, FRAME, PANE)).toEqual(view);
  expect(kept({ ...view, x: 5000 }, FRAME, PANE).x).toBe(260);
  expect(kept({ ...view, y: -5000 }, FRAME, PANE).y).toBe(145 - 500);
});

test("what is not seen comes to the middle of the pane, and what is seen moves nothing", () => {
  const view = { zoom: 2, x: -400, y: -100 };
  const seen = { x: 500, y: 280, width: 40, height: 20 };
  expect(showing(view, seen, PANE)).toBe(view);
  expect(showing(view, { ...seen, x: 501 }, PANE)).toEqual({ zoom: 2, x: -400 + 260 - 521, y: -100 + 145 - 290 });
  expect(showing(view, { ...seen, y: -40 }, PANE)).toEqual({ zoom: 2, x: -400 + 260 - 520, y: -100 + 145 + 30 });
});

test("what is larger than the pane is seen wherever a part of it is", () => {
  const view = { zoom: 2, x: -400, y: -100 };
  for (const [x, y] of [
    [0, 0],
    [-1400, -700],
    [500, 280],
  ] as const)
    expect(showing(view, { x, y, width: 2000, height: 1000 }, PANE)).toBe(view);
  const wide = { x: -1400, y: 270, width: 2000, height: 20 };
  expect(showing(view, wide, PANE)).toBe(view);
  for (const off of [{ x: 520 }, { x: -2000 }, { y: 290 }])
    expect(showing(view, { ...wide, ...off }, PANE)).not.toEqual(view);
});
