import { expect, test } from "vitest";
import { readPgm } from "./pgm";

const bytes = (header: string, ...rest: number[]) => new Uint8Array([...new TextEncoder().encode(header), ...rest]);
const shades = (file: Uint8Array) => [...(readPgm(file)?.pixels ?? [])];

test("a binary image with a comment in its header", () => {
  const image = readPgm(bytes("P5\n# CREATOR: map_saver\n3 2\n255\n", 0, 127, 255, 254, 205, 1));
  expect(image && { ...image, pixels: [...image.pixels] }).toEqual({
    width: 3,
    height: 2,
    pixels: [0, 127, 255, 254, 205, 1],
  });
});

test("pixels may look like white space", () => {
  expect(shades(bytes("P5 2 1 255\n", 10, 32))).toEqual([10, 32]);
});

test("a plain image, with comments between the numbers", () => {
  expect(shades(bytes("P2\n2 2\n255\n0 64 # half\n128\n255\n"))).toEqual([0, 64, 128, 255]);
});

test("other depths are stretched to 255", () => {
  expect(shades(bytes("P2 3 1 15 0 7 15"))).toEqual([0, 119, 255]);
  expect(shades(bytes("P5 2 1 65535\n", 255, 255, 0, 0))).toEqual([255, 0]);
});

test.each([
  ["a PNG", bytes("\u0089PNG\r\n", 26, 10, 0, 0)],
  ["an image cut short", bytes("P5 4 4 255\n", 1, 2, 3)],
  ["no size", bytes("P5 0 4 255\n")],
  ["more than can be shown", bytes("P5 100000 100000 255\n")],
  ["a depth of nothing", bytes("P5 1 1 0\n", 1)],
  ["an empty file", new Uint8Array()],
])("refuses %s", (_, file) => {
  expect(readPgm(file)).toBeNull();
});
