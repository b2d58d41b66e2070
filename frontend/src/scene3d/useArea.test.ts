// @vitest-environment jsdom
import { cleanup, renderHook } from "@testing-library/react";
import { afterEach, expect, test } from "vitest";
import type { SceneMap } from "./types";
import { useArea } from "./useArea";

afterEach(cleanup);
const HALL: SceneMap = {
  width: 40,
  height: 20,
  resolution_m: 0.5,
  origin: { x: -2, y: -8 },
  cells: new Uint8Array(800),
  version: 3,
  places: [],
};

test("it has the floor's middle and sides in metres", () => {
  const { centre, width, depth } = renderHook(() => useArea(HALL)).result.current;
  expect([centre.toArray(), width, depth]).toEqual([[8, 0, 3], 20, 10]);
});

test("what is on the floor leaves it as it is, so that the camera stays; another floor does not", () => {
  const { result, rerender } = renderHook((map: SceneMap) => useArea(map), { initialProps: HALL });
  const first = result.current;
  rerender({ ...HALL, origin: { ...HALL.origin }, obstacles: [{ x: 1, y: 1, size_m: 0.5 }] });
  rerender({ ...HALL, version: 4, cells: new Uint8Array(800).fill(100) });
  expect(result.current).toBe(first);
  for (const other of [{ width: 41 }, { height: 21 }, { resolution_m: 0.4 }, { origin: { x: -2, y: 0 } }]) {
    const before = result.current;
    rerender({ ...HALL, ...other });
    expect(result.current).not.toBe(before);
  }
});
