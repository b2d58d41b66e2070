import { expect, test } from "vitest";
import { boxAt, overlaps } from "@/program/scene/geometry";
import type { FloorPlan } from "@/map/floor/floor";
import { freeNear, freeOn } from "./freeSpot";

const SIZE = { width: 100, height: 30 };
const FLOOR = { left: 0, right: 1000, top: 0, bottom: 600 };

test("the next chip stands right below where there is room", () => {
  expect(freeNear({ x: 300, y: 100 }, SIZE, [boxAt({ x: 300, y: 100 }, 100, 30)], FLOOR)).toEqual({ x: 300, y: 146 });
});

test("what stands below is walked around", () => {
  const below = { left: 200, right: 400, top: 130, bottom: 180 };
  expect(freeNear({ x: 300, y: 100 }, SIZE, [boxAt({ x: 300, y: 100 }, 20, 20), below], FLOOR)).toEqual({
    x: 370,
    y: 100,
  });
});

test("no chip stands beyond the floor's edge", () => {
  const at = freeNear({ x: 300, y: 590 }, SIZE, [boxAt({ x: 300, y: 590 }, 100, 30)], FLOOR);
  expect(at && at.y < 600).toBe(true);
});

test("a full floor has no place", () => {
  expect(freeNear({ x: 300, y: 300 }, SIZE, [FLOOR], FLOOR)).toBeNull();
});

/** So many metres each way, its bottom left at a point. */
function hall(width: number, height: number, x: number, y: number): FloorPlan {
  const cells = new Uint8Array(width * height);
  return { version: 1, width, height, resolution_m: 1, origin: { x, y }, places: [], cells };
}

test("on a floor that is too small the next chip does not stand on the one before", () => {
  const taken = [boxAt({ x: 69, y: 69 }, 100, 30)];
  for (let number = 0; number < 4; number += 1) {
    const at = freeOn(hall(3, 3, 0, -3), { x: 69, y: 69 }, { width: 150, height: 30 }, taken);
    expect(taken.some((each) => overlaps(each, boxAt(at, 150, 30)))).toBe(false);
    taken.push(boxAt(at, 150, 30));
  }
});

test("a chip that would stand far from the floor stands in its middle; one just beside it stays near", () => {
  const far = hall(20, 20, 500_000, 500_000);
  const at = freeOn(far, { x: 46, y: 46 }, SIZE, []);
  expect(at).toEqual({ x: 500_010 * 46, y: -500_010 * 46 + 46 });
  expect(freeOn(hall(20, 20, 0, -20), { x: 300, y: -40 }, SIZE, [])).toEqual({ x: 300, y: 52 });
});
