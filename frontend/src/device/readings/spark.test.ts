import { expect, test } from "vitest";
import { cornersOf, joinReadings, rangeOf, sparkPath } from "./spark";

const FRAME = { now: 1000, window_ms: 1000, width: 100, height: 30 };

test("nothing is drawn without readings", () => {
  expect(sparkPath([], FRAME)).toBeNull();
});

test("the highest reading lies at a tenth, the lowest at nine tenths, and the line goes on to now", () => {
  const path = sparkPath(
    [
      { at: 0, value: 10 },
      { at: 500, value: 20 },
    ],
    FRAME,
  );
  expect(path?.line).toBe("M0 27L50 3L100 3");
  expect(path?.area).toBe("M0 27L50 3L100 3V30H0Z");
  expect(path?.end).toEqual([100, 3]);
});

test("a steady value lies in the lower third", () => {
  expect(sparkPath([{ at: 200, value: 5 }], FRAME)?.line).toBe("M20 21L100 21");
});

test("what was read before the window counts as its left edge", () => {
  const path = sparkPath(
    [
      { at: -900, value: 0 },
      { at: -400, value: 10 },
      { at: 500, value: 20 },
    ],
    FRAME,
  );
  expect(path?.line).toBe("M0 27L50 3L100 3");
});

test("what was kept ends where the live readings begin", () => {
  const kept = [
    { at: -5000, value: 1 },
    { at: 300, value: 2 },
  ];
  const live = [{ at: 100, value: 7 }];
  expect(joinReadings(kept, live)).toEqual([
    { at: -5000, value: 1 },
    { at: 100, value: 7 },
  ]);
  expect(joinReadings(kept, [])).toEqual(kept);
});

test("the range is of the window, with what held when it began", () => {
  const readings = [
    { at: -900, value: 50 },
    { at: -400, value: 10 },
    { at: 500, value: 20 },
  ];
  expect(rangeOf(readings, FRAME)).toEqual({ low: 10, high: 20 });
});

test("a reading holds until it changes, and what it reached within its span is drawn", () => {
  const kept = [
    { at: 0, value: 20, minimum: 18, maximum: 30 },
    { at: 60, value: 21, minimum: 21, maximum: 21 },
    { at: 600, value: 25, minimum: 25, maximum: 25 },
  ];
  expect(cornersOf(kept, 60).map(({ at, value }) => [at, value])).toEqual([
    [0, 18],
    [0, 30],
    [0, 20],
    [60, 21],
    [540, 21],
    [600, 25],
  ]);
});
