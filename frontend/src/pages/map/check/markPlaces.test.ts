import { expect, test } from "vitest";
import { markPlaces } from "./markPlaces";

test("findings at one place stand beside each other, those with room of their own where they are", () => {
  const door = { x: 100, y: 40 };
  expect(markPlaces([door, door, { x: 400, y: 40 }, door], 24)).toEqual([
    door,
    { x: 124, y: 40 },
    { x: 400, y: 40 },
    { x: 148, y: 40 },
  ]);
});

test("who is only near moves no farther than needed", () => {
  const places = markPlaces(
    [
      { x: 100, y: 40 },
      { x: 90, y: 45 },
    ],
    24,
  );
  expect(places[1]).toEqual({ x: 124, y: 45 });
});
