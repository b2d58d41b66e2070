import { expect, test } from "vitest";
import { byStep, percentOver, stripOf } from "./paces";

test("what is as good as the model's time is said to be so", () => {
  expect([1, 1.02, 0.98, 1.2, 0.8].map(percentOver)).toEqual([0, 0, 0, 20, -20]);
});

test("a strip shows the model's time, the band and the newest ten", () => {
  const newest = Array.from({ length: 30 }, (_, index) => ({ predicted_s: 10, real_s: index < 20 ? 10 : 12 }));
  const strip = stripOf({ newest, band: [1, 1.2] });
  expect(strip?.dots).toHaveLength(30);
  expect(strip?.dots.filter((dot) => dot.newest)).toHaveLength(10);
  expect(strip?.dots[29]?.y).toBeLessThan(strip?.model ?? 0);
  expect([strip?.low, strip?.high]).toEqual([1, 1.2]);
  expect(strip?.band[0]).toBeLessThan(strip?.band[1] ?? 0);
});

test("equal paces still have a place on the scale", () => {
  const strip = stripOf({ newest: [{ predicted_s: 1, real_s: 1 }], band: [1, 1] });
  expect(strip?.dots[0]?.y).toBeCloseTo(0.5);
  expect(stripOf({ newest: [], band: null })).toBeNull();
});

test("the commands of one step count together", () => {
  const part = { step: "a", device: "r", method: "move", count: 1, apart_m: null };
  const steps = byStep([
    { ...part, real_s: 4, predicted_s: 3 },
    { ...part, real_s: 2, predicted_s: 2 },
    { ...part, step: "b", real_s: 1, predicted_s: 1 },
  ]);
  expect(steps.get("a")).toEqual({ real_s: 6, predicted_s: 5 });
  expect(steps.size).toBe(2);
});
