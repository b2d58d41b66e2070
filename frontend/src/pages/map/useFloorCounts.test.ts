// @vitest-environment jsdom
import { cleanup, renderHook } from "@testing-library/react";
import { afterEach, expect, test } from "vitest";
import { countFloor, useFloorCounts } from "./useFloorCounts";

afterEach(cleanup);

/** Cells that count how often somebody looks at all of them. */
class CountedCells extends Uint8Array {
  walks = 0;
  override [Symbol.iterator]() {
    this.walks += 1;
    return super[Symbol.iterator]();
  }
}

test("free cells are counted, and the part of all that is known", () => {
  expect(countFloor(Uint8Array.of(0, 0, 100, 255))).toEqual({ free: 2, known: 0.75 });
  expect(countFloor(new Uint8Array())).toEqual({ free: 0, known: 0 });
});

test("cells are looked at once, however often what shows their numbers is drawn", () => {
  const [first, second] = [new CountedCells([0, 255]), new CountedCells([0, 0])];
  const { result, rerender } = renderHook((cells: Uint8Array) => useFloorCounts(cells), { initialProps: first });
  rerender(first);
  rerender(first);
  expect([result.current.free, first.walks]).toEqual([1, 1]);
  rerender(second);
  expect([result.current.free, second.walks]).toEqual([2, 1]);
});
