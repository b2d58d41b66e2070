import { expect, test } from "vitest";
import { boxAt } from "@/program/scene/geometry";
import { freeNear } from "./freeSpot";

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
