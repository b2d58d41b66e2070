import { expect, test } from "vitest";
import { nameHeight } from "./robotPainter";
import type { RobotView } from "./robots";

const robot = { id: "r", name: "Kiwi", x: 0, y: 0, theta: 0, status: "idle" } as RobotView;
const box = (top: number) => ({ left: -20, right: 20, top, bottom: top + 10 });

test("a robot's name stands below it, and above where a chip is in the way", () => {
  expect(nameHeight(robot, [])).toBe(38);
  expect(nameHeight(robot, [box(30)])).toBe(-42);
  expect(nameHeight(robot, [{ ...box(30), left: 60, right: 90 }])).toBe(38);
});

test("between two chips it stays below", () => {
  expect(nameHeight(robot, [box(30), box(-50)])).toBe(38);
});
