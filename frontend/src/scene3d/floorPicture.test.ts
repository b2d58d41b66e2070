import { expect, test } from "vitest";
import { pixelsPerMetre } from "./floorPicture";

test.each([
  ["a room", 200, 100, 40],
  ["a hall of 200 m", 4000, 2000, 4096 / 200],
  ["a deep hall", 100, 8000, 4096 / 400],
])("the floor of %s is drawn with as many pixels as a tablet takes", (_, width, height, pixels) => {
  expect(pixelsPerMetre({ width, height, resolution_m: 0.05 })).toBe(pixels);
});
