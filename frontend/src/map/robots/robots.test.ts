import { expect, test } from "vitest";
import { apartOf, interpolatePose, Trails, turn, type RobotView } from "./robots";

test("a robot is drawn between its last two poses", () => {
  const pose = interpolatePose({ x: 0, y: 0, theta: 0, at: 0 }, { x: 1, y: 2, theta: 1, at: 100 }, 150);
  expect(pose).toEqual({ x: 0.5, y: 1, theta: 0.5 });
});

test("a robot is never drawn beyond its newest pose", () => {
  const pose = interpolatePose({ x: 0, y: 0, theta: 0, at: 0 }, { x: 1, y: 0, theta: 0, at: 100 }, 900);
  expect(pose.x).toBe(1);
});

test("after a gap a robot jumps instead of gliding", () => {
  const pose = interpolatePose({ x: 0, y: 0, theta: 0, at: 0 }, { x: 1, y: 0, theta: 0, at: 5000 }, 5001);
  expect(pose.x).toBe(1);
});

test("a turn takes the short way round", () => {
  expect(turn(3, -3)).toBeCloseTo(2 * Math.PI - 6);
});

test("a trail forgets what is older than 30 s and does not grow while the robot stands", () => {
  const trails = new Trails();
  const robot = { id: "r", name: "r", status: "idle", x: 0, y: 0, theta: 0 } as RobotView;
  trails.add(robot, 0);
  trails.add(robot, 100);
  expect(trails.of("r", 100)).toHaveLength(1);
  trails.add({ ...robot, x: 5 }, 31_000);
  expect(trails.of("r", 31_000)).toEqual([{ x: 5, y: 0, fresh: 1, seen: false }]);
});

test("a trail has a gap where the robot was not seen, instead of a line through walls", () => {
  const trails = new Trails();
  const robot = { id: "r", name: "r", status: "busy", x: 0, y: 0, theta: 0 } as RobotView;
  [0, 0.5, 7, 7.5].forEach((x, second) => trails.add({ ...robot, x }, second * 1000));
  expect(trails.of("r", 3000).map(({ x, seen }) => [x, seen])).toEqual([
    [0, false],
    [0.5, true],
    [7, false],
    [7.5, true],
  ]);
});

test("a copy that is where its robot is, is nothing to speak of; another says how far it is", () => {
  expect(apartOf({ x: 1, y: 2 }, { x: 1.1, y: 2.1 })).toBeNull();
  expect(apartOf({ x: 4, y: 6 }, { x: 1, y: 2 })).toBe(5);
});
