import { expect, test } from "vitest";
import { nameHeight } from "./robotPainter";
import type { Box } from "../plane/projection";
import type { RobotView } from "./robots";

const robot = { id: "r", name: "Kiwi", x: 0, y: 0, theta: 0, status: "idle" } as RobotView;
const taken =
  (...boxes: readonly Box[]) =>
  (wanted: Box) =>
    boxes.some(
      (each) =>
        each.left < wanted.right && each.right > wanted.left && each.top < wanted.bottom && each.bottom > wanted.top,
    );
const box = (top: number) => ({ left: -20, right: 20, top, bottom: top + 10 });

test("a robot's name stands below it, and above where a chip is in the way", () => {
  expect(nameHeight(robot, taken())).toBe(38);
  expect(nameHeight(robot, taken(box(30)))).toBe(-42);
  expect(nameHeight(robot, taken({ ...box(30), left: 60, right: 90 }))).toBe(38);
});

test("between two chips it stays below", () => {
  expect(nameHeight(robot, taken(box(30), box(-50)))).toBe(38);
});
