import { expect, test } from "vitest";
import { boxAt } from "./geometry";
import { floorNames, labelPlace, labelWidth } from "./labels";

const MACHINE = boxAt({ x: 0, y: 0 }, 100, 60);

test("a name stands below its machine where nothing is in the way", () => {
  expect(labelPlace(MACHINE, 80, [])).toMatchObject({ side: "below", gap: 0 });
});

test("a chip docked below sends the name above", () => {
  expect(labelPlace(MACHINE, 80, [boxAt({ x: 0, y: 30 }, 120, 28)])).toMatchObject({ side: "above", gap: 0 });
});

test("with a route above and a chip below the name stands beyond the chip", () => {
  const covers = [boxAt({ x: 0, y: 30 }, 120, 28), boxAt({ x: 0, y: -60 }, 6, 60)];
  expect(labelPlace(MACHINE, 80, covers)).toMatchObject({ side: "below", gap: 19 });
});

test("with both ends taken the name stands beside", () => {
  const covers = [boxAt({ x: 0, y: 60 }, 120, 80), boxAt({ x: 0, y: -60 }, 120, 80)];
  expect(labelPlace(MACHINE, 80, covers).side).toBe("right");
});

test("a label is as wide as its longer line", () => {
  expect(labelWidth("Oven", "Ready")).toBeCloseTo(34);
});

test("the name of a room is in the way where it is written", () => {
  const room = { id: "r", name: "Mixing", kind: "room", x: 1, y: -1, theta: 0, label: [2, -3] as const };
  const [box] = floorNames([room]);
  expect([Math.round(box?.left ?? 0), Math.round(box?.bottom ?? 0)]).toEqual([90, 142]);
});
