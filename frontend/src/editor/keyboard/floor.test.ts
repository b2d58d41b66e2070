/** A point goes by metres and centimetres, jumps to what has a name, and is said beside what is nearest. */
import { expect, test } from "vitest";
import { exampleSite } from "../beginning/exampleSite";
import { byLetter, landmarksOf, nearest, stepped } from "./floor";

const { devices, places } = exampleSite();
const landmarks = landmarksOf(devices, places);
const bounds = { left: 0, right: 24, bottom: -13.4, top: 0 };

test("an arrow is a metre, with Shift ten centimetres, and up is up", () => {
  expect(stepped([4, -3], "ArrowRight", false, bounds)).toEqual([5, -3]);
  expect(stepped([4, -3], "ArrowUp", false, bounds)).toEqual([4, -2]);
  expect(stepped([4, -3], "ArrowDown", true, bounds)).toEqual([4, -3.1]);
  expect(stepped([0.3, -0.1], "ArrowLeft", true, null)).toEqual([0.2, -0.1]);
  expect(stepped([4, -3], "x", false, bounds)).toBeNull();
});

test("the point stays on the known floor", () => {
  expect(stepped([23.5, -3], "ArrowRight", false, bounds)).toEqual([24, -3]);
  expect(stepped([4, -13], "ArrowDown", false, bounds)).toEqual([4, -13.4]);
});

test("machines are jumped to by their names, then places; robots, which move, are not", () => {
  const names = landmarks.map(({ name }) => name);
  expect(names[0]).toBe("Curing Oven");
  expect(names).toContain("Goods in");
  expect(names.some((name) => name.startsWith("TurtleBot"))).toBe(false);
});

test("a letter goes to the next name that begins with it, and from the last to the first", () => {
  const at = (index: number | null) => (index === null ? null : landmarks[index]?.name);
  const first = byLetter(landmarks, -1, "p");
  expect(at(first)).toBe("Paint Inventory");
  const second = byLetter(landmarks, first ?? 0, "P");
  expect(at(second)).toBe("Paint Mixer A");
  const last = landmarks.findLastIndex(({ name }) => name.startsWith("P"));
  expect(at(byLetter(landmarks, last, "p"))).toBe("Paint Inventory");
  expect(byLetter(landmarks, -1, "z")).toBeNull();
});

test("a point is said from the nearest name", () => {
  expect(nearest([2.3, -1.95], landmarks)).toEqual({ name: "Item Inventory", metres: 0, side: "at" });
  expect(nearest([1.1, -1.95], landmarks)).toEqual({ name: "Item Inventory", metres: 1.2, side: "left" });
  expect(nearest([2.3, -0.9], landmarks)?.side).toBe("above");
  expect(nearest([1, 1], [])).toBeNull();
});
