import { expect, test } from "vitest";
import { latest, poseAt } from "@/scene3d/frames";
import { EVERY_S, LiveRecording, type Seen } from "./liveRecording";

const at = (x: number, carrying = {}, route: [number, number][] = [], busy = false): Seen => ({
  robots: { r: { pose: [x, 0, 0], carrying, route } },
  machines: { oven: busy },
});

test("a pose is shown between the two that were seen around it, a moment late", () => {
  const live = new LiveRecording();
  live.see(100, at(0));
  live.see(100.1, at(1));
  live.show(100.15);
  expect(live.moment.t_s).toBeCloseTo(0.05);
  expect(poseAt(live.recording.frames, "r", live.moment.t_s)?.[0]).toBeCloseTo(0.5);
});

test("what was not seen for a while stood as it had been", () => {
  const live = new LiveRecording();
  live.see(0, at(0));
  live.see(2, at(4));
  expect(poseAt(live.recording.frames, "r", 1.5)?.[0]).toBe(0);
  expect(poseAt(live.recording.frames, "r", 2)?.[0]).toBe(4);
});

test("loads, machines and paths are noted when they change, in the recording that is drawn", () => {
  const live = new LiveRecording();
  live.see(0, at(0, {}, [[1, 0]]));
  const first = live.recording;
  live.see(1, at(0, {}, [[1, 0]], true));
  expect(live.recording).toBe(first);
  expect(live.recording.machine_states.oven).toEqual([
    [0, false],
    [1, true],
  ]);
  live.see(2, at(0, { box: 1 }, [[2, 0]], true));
  expect(live.recording).toBe(first);
  expect(live.recording.routes.r).toEqual([
    [0, [[1, 0]]],
    [2, [[2, 0]]],
  ]);
  expect(latest(live.recording.carrying.r, 5)?.[1]).toEqual({ box: 1 });
});

test("an hour needs no more room than four minutes, and nothing jumps where old poses are let go", () => {
  const live = new LiveRecording();
  let most = 0;
  for (let step = 0; step <= 36_000; step += 1) {
    const now_s = step * EVERY_S;
    live.see(now_s, at(now_s, step < 50 ? {} : { box: 1 }));
    live.show(now_s);
    most = Math.max(most, live.recording.frames.robots.r?.length ?? 0);
    if (step > 1) expect(poseAt(live.recording.frames, "r", live.moment.t_s)?.[0]).toBeCloseTo(now_s - EVERY_S, 3);
  }
  expect(most).toBeLessThan(2_500);
  expect(live.recording.carrying.r).toHaveLength(1);
  expect(latest(live.recording.carrying.r, live.moment.t_s)?.[1]).toEqual({ box: 1 });
});

test("two hundred robots that follow long paths cost nothing but their poses", () => {
  const live = new LiveRecording();
  const route = Array.from({ length: 200 }, (_, index): [number, number] => [index, 0]);
  const robots = Object.fromEntries(
    Array.from({ length: 200 }, (_, index) => [`r${index}`, { pose: [index, 0, 0] as const, carrying: {}, route }]),
  );
  let written = 0;
  const plain = JSON.stringify;
  JSON.stringify = ((...given: Parameters<typeof plain>) => ((written += 1), plain(...given))) as typeof plain;
  try {
    for (let step = 0; step < 50; step += 1) live.see(step * EVERY_S, { robots, machines: {} });
  } finally {
    JSON.stringify = plain;
  }
  expect(written).toBe(0);
  expect(live.recording.routes.r7).toHaveLength(1);
});

test("after a long sleep of the page it begins anew", () => {
  const live = new LiveRecording();
  live.see(0, at(0));
  live.see(4_000, at(9));
  live.show(4_000);
  expect(live.recording.frames.robots.r).toEqual([[9, 0, 0]]);
  expect(poseAt(live.recording.frames, "r", live.moment.t_s)?.[0]).toBe(9);
});

test.each([
  ["a robot that drives", at(1)],
  ["a load", at(0, { box: 1 })],
  ["a path", at(0, {}, [[1, 0]])],
  ["a machine at work", at(0, {}, [], true)],
])("%s makes it lively for two seconds", (_, then) => {
  const live = new LiveRecording();
  live.see(0, at(0));
  live.see(5, at(0));
  expect(live.isLively(5)).toBe(false);
  live.see(6, then);
  live.see(7, then);
  expect(live.isLively(7.9)).toBe(true);
  live.see(8.1, then);
  expect(live.isLively(8.1)).toBe(false);
});

test("a robot may have the name of what every object has", () => {
  const live = new LiveRecording();
  const named = (robot: Seen["robots"][string]): Seen => ({ robots: { constructor: robot }, machines: {} });
  live.see(0, named({ pose: [1, 0, 0], carrying: {}, route: [] }));
  live.see(1, named({ pose: [2, 0, 0], carrying: {}, route: [] }));
  expect(poseAt(live.recording.frames, "constructor", 1)?.[0]).toBe(2);
});
