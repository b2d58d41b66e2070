import { describe, expect, it } from "vitest";
import { latest, poseAt, trailBefore } from "./frames";

const frames = {
  dt_s: 0.5,
  robots: {
    r: [
      [0, 0, 3],
      [1, 0, -3],
      [2, 0, -3],
    ] as [number, number, number][],
  },
};

describe("poseAt", () => {
  it("lies between two recorded poses", () => expect(poseAt(frames, "r", 0.75)?.slice(0, 2)).toEqual([1.5, 0]));
  it("turns the shorter way", () => expect(Math.abs(poseAt(frames, "r", 0.25)?.[2] ?? 0)).toBeCloseTo(Math.PI, 1));
  it("stays at the ends", () => {
    expect(poseAt(frames, "r", -4)).toEqual([0, 0, 3]);
    expect(poseAt(frames, "r", 99)?.slice(0, 2)).toEqual([2, 0]);
  });
  it("knows no robot that was not recorded", () => expect(poseAt(frames, "x", 0)).toBeNull());
});

describe("latest", () => {
  const entries: [number, string][] = [
    [0, "a"],
    [2, "b"],
    [2, "c"],
    [9, "d"],
  ];
  it("takes the newest that is not later", () => expect(latest(entries, 2)).toEqual([2, "c"]));
  it("is null before the first", () => expect(latest(entries, -1)).toBeNull());
});

describe("trailBefore", () => {
  it("covers the seconds before", () =>
    expect(trailBefore(frames, "r", 1, 0.5)).toEqual([
      [1, 0],
      [2, 0],
    ]));
});
