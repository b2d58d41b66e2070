import { expect, test } from "vitest";
import { toPixels } from "@/map/plane/projection";
import { boxAt } from "@/program/scene/geometry";
import { spotByRobot } from "./placement";

test("a step of a robot stands above it, clear of other robots and of other steps", () => {
  const robot = boxAt({ x: 500, y: 500 }, 36, 36);
  const first = toPixels(spotByRobot(robot, [robot]));
  expect([Math.round(first.x), first.y < robot.top]).toEqual([500, true]);
  const second = toPixels(spotByRobot(robot, [robot, boxAt(first, 150, 30)]));
  expect(second.y < first.y - 15).toBe(true);
});
