import { expect, test } from "vitest";
import { scaleBar } from "./scaleBar";

test("the bar is of a round length and no wider than there is room", () => {
  expect(scaleBar(1, 40, 100)).toEqual({ metres: 2, pixels: 80 });
  expect(scaleBar(0.05, 40, 100)).toEqual({ metres: 50, pixels: 100 });
  expect(scaleBar(8, 40, 100).metres).toBeCloseTo(0.2);
});
