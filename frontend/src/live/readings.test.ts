import { beforeEach, expect, test } from "vitest";
import type { DeviceProperty, Scalar } from "@/api/types";
import { forgetReadings, poseOf, readingsOf, recordDevice } from "./readings";

const telling = (value: Scalar | null) => ({
  id: "oven",
  properties: [{ name: "temperature", value } as DeviceProperty],
});
const at = (x: number) => ({ id: "robot", location: { x, y: 0, z: 0, theta: 0 } });

beforeEach(forgetReadings);

test("readings are kept in order, with their times", () => {
  recordDevice(telling(20), 100);
  recordDevice(telling(21), 200);
  expect(readingsOf("oven", "temperature")).toEqual([
    { at: 100, value: 20 },
    { at: 200, value: 21 },
  ]);
});

test("a steady value is kept as its two ends", () => {
  for (const now of [100, 200, 300, 400]) recordDevice(telling(20), now);
  expect(readingsOf("oven", "temperature").map((each) => each.at)).toEqual([100, 400]);
});

test("a property without a value leaves no reading", () => {
  recordDevice(telling(null), 100);
  expect(readingsOf("oven", "temperature")).toEqual([]);
});

test("only the last 240 readings are kept", () => {
  for (let now = 0; now < 300; now += 1) recordDevice(telling(now), now);
  const kept = readingsOf("oven", "temperature");
  expect([kept.length, kept[0]?.value, kept.at(-1)?.value]).toEqual([240, 60, 299]);
});

test("a robot's last two poses are kept; standing still is no new pose", () => {
  recordDevice(at(1), 100);
  recordDevice(at(2), 200);
  recordDevice(at(2), 300);
  expect([poseOf("robot")?.previous?.x, poseOf("robot")?.current.x, poseOf("robot")?.current.at]).toEqual([1, 2, 200]);
});

test("another site begins with nothing", () => {
  recordDevice(at(1), 100);
  recordDevice(telling(20), 100);
  forgetReadings();
  expect(poseOf("robot")).toBeUndefined();
  expect(readingsOf("oven", "temperature")).toEqual([]);
});
