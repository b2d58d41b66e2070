import { expect, test } from "vitest";
import type { RehearsalResult } from "@/api/types";
import { figuresOf, usedByOne } from "./figures";

function rehearsed(changes: Partial<RehearsalResult>): RehearsalResult {
  return {
    ok: true,
    duration_s: 90,
    errors: [],
    robots: {},
    machines: {},
    near_misses: [],
    collisions: [],
    waits: [],
    steps: [],
    frames: { dt_s: 1, robots: {} },
    carrying: {},
    machine_states: {},
    properties: {},
    routes: [],
    obstacles: [],
    zone_waits: {},
    log: [],
    ...changes,
  };
}

function done(robot: string, device: string): RehearsalResult["steps"][number] {
  return { step: "s", count: 1, robot, device, started_s: 0, ended_s: 1, status: "done" };
}

test("robots that only stood are not counted, and what they turned is no distance", () => {
  const still = { distance_m: 0.01, busy_s: 0, wait_s: 0, battery: 100 };
  const figures = figuresOf(rehearsed({ robots: { a: { ...still, distance_m: 12.5 }, b: still } }));
  expect([figures.robots, figures.distance_m]).toEqual([1, 12.5]);
});

test("waits are counted and summed, near misses and collisions are one figure", () => {
  const why = { kind: "robot" } as unknown as RehearsalResult["waits"][number]["why"];
  const wait = { t: 1, duration_s: 4, robot: "a", reason: "", why };
  const met = { t: 1, a: "a", b: "b", distance_m: 0.1, x: 0, y: 0 };
  const figures = figuresOf(rehearsed({ waits: [wait, wait], near_misses: [met], collisions: [met, met] }));
  expect([figures.waits, figures.waited_s, figures.encounters]).toEqual([2, 8, 3]);
});

test("a device that only one side uses is told once, steps without a device are not", () => {
  const old = rehearsed({ steps: [done("r1", "oven"), done("r1", "oven"), done("", "")] });
  const next = rehearsed({ steps: [done("r2", "oven"), done("r2", "mixer")] });
  expect(usedByOne(old, next)).toEqual({ old: ["r1"], new: ["mixer", "r2"] });
});
