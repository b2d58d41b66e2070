import { describe, expect, it } from "vitest";
import { latest, poseAt, straightened, trailBefore } from "./frames";

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

describe("straightened", () => {
  it("keeps a straight line's ends and each corner", () => {
    const line = Array.from({ length: 50 }, (_, index) => [index / 10, 0] as const);
    const corner = Array.from({ length: 20 }, (_, index) => [4.9, (index + 1) / 10] as const);
    expect(straightened([...line, ...corner])).toEqual([
      [0, 0],
      [4.9, 0],
      [4.9, 2],
    ]);
  });
  it("follows a curve to within a few centimetres", () => {
    const curve = Array.from({ length: 200 }, (_, index) => {
      const angle = (index / 199) * Math.PI;
      return [2 * Math.cos(angle), 2 * Math.sin(angle)] as const;
    });
    const kept = straightened(curve);
    expect(kept.length).toBeLessThan(90);
    for (let index = 1; index < kept.length; index += 1) {
      const [[ax, ay], [bx, by]] = [kept[index - 1] ?? [0, 0], kept[index] ?? [0, 0]];
      expect(2 - Math.hypot((ax + bx) / 2, (ay + by) / 2)).toBeLessThan(0.03);
    }
  });
  it("is one point for a robot that stands", () =>
    expect(straightened(Array.from({ length: 9 }, () => [1, 1]))).toEqual([[1, 1]]));
});
