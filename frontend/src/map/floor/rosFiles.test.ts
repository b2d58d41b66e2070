import { expect, test } from "vitest";
import { writePgm, writeYaml } from "./rosFiles";

const MAP = {
  width: 2,
  height: 2,
  resolution_m: 0.05,
  origin: { x: -1.25, y: 2 },
  cells: Uint8Array.of(0, 100, 255, 0),
};

test("the image has the top row first, in map_server's three shades", () => {
  const file = writePgm(MAP);
  expect(new TextDecoder("latin1").decode(file.subarray(0, 11))).toBe("P5\n2 2\n255\n");
  expect([...file.subarray(11)]).toEqual([205, 254, 254, 0]);
});

test("the header tells resolution and origin as they are", () => {
  expect(writeYaml(MAP, "a.pgm").split("\n").slice(0, 4)).toEqual([
    "image: a.pgm",
    "mode: trinary",
    "resolution: 0.05",
    "origin: [-1.25, 2, 0]",
  ]);
});
