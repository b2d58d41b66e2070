import { expect, test } from "vitest";
import { onScreen } from "./InSmall";

test("words of a map in small stay as large as they can be read, up to a limit", () => {
  expect(onScreen(1)).toBe(1);
  expect(onScreen(0.5) * 0.5).toBeCloseTo(0.87);
  expect(onScreen(0.1)).toBe(2.4);
});
