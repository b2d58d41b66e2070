import { expect, test } from "vitest";
import { isTooLarge, mapFromPicture, pictureOf, pixelSize, planSize, type PlanReading } from "./picture";

const READING: PlanReading = {
  threshold: 128,
  line: [
    [0, 0],
    [4, 0],
  ],
  length: 0.2,
  outsideUnknown: false,
};

/** A picture out of rows of `#` dark, `.` light and `?` see-through. */
function drawn(...rows: string[]) {
  const colours: Record<string, number[]> = { "#": [10, 20, 30, 255], ".": [250, 250, 250, 255], "?": [0, 0, 0, 0] };
  const data = rows.flatMap((row) => [...row].flatMap((letter) => colours[letter] ?? []));
  return pictureOf({ width: rows[0]?.length ?? 0, height: rows.length, data });
}

test("dark is wall, light is floor, see-through is unknown, and the bottom row comes first", () => {
  const map = mapFromPicture(drawn("#.?", "..."), READING);
  expect([...(map?.cells ?? [])]).toEqual([0, 0, 0, 100, 0, 255]);
  expect(map?.resolution_m).toBe(0.05);
});

test("a line of known length says how wide a pixel is", () => {
  expect(
    pixelSize({
      line: [
        [0, 0],
        [30, 40],
      ],
      length: 10,
    }),
  ).toBe(0.2);
  expect(
    pixelSize({
      line: [
        [5, 5],
        [5, 5],
      ],
      length: 10,
    }),
  ).toBeNull();
  expect(
    pixelSize({
      line: [
        [0, 0],
        [30, 40],
      ],
      length: 0,
    }),
  ).toBeNull();
  expect(
    pixelSize({
      line: [
        [0, 0],
        [2, 0],
      ],
      length: 50_000,
    }),
  ).toBeNull();
});

test("a length in centimetres makes no map of square kilometres", () => {
  expect(planSize(drawn("...."), { ...READING, length: 0 })).toBeNull();
  const wide = { width: 4000, height: 3000, light: new Uint8Array(12_000_000), opaque: new Uint8Array(12_000_000) };
  const inCentimetres = { ...READING, line: [[0, 0], [4000, 0]], length: 4000 } as const; // prettier-ignore
  expect(planSize(wide, inCentimetres)).toEqual({ width: 4000, height: 3000 });
  expect(isTooLarge({ width: 4000, height: 3000 })).toBe(true);
  expect(mapFromPicture(wide, inCentimetres)).toBeNull();
  expect(mapFromPicture(wide, { ...inCentimetres, length: 40 })?.width).toBe(800);
});

test("fine pixels are put together to cells, and a thin wall stays", () => {
  const map = mapFromPicture(drawn("....", ".#..", "....", "...."), { ...READING, length: 0.1 });
  expect([map?.width, map?.height, map?.resolution_m]).toEqual([2, 2, 0.05]);
  expect([...(map?.cells ?? [])]).toEqual([0, 0, 100, 0]);
});

test("what is outside of the walls can be unknown, what they enclose stays floor", () => {
  const map = mapFromPicture(drawn(".....", ".###.", ".#.#.", ".###.", "....."), { ...READING, outsideUnknown: true });
  const cells = [...(map?.cells ?? [])];
  expect([cells[12], cells.filter((cell) => cell === 0).length, cells.filter((cell) => cell === 255).length]).toEqual([
    0, 1, 16,
  ]);
});
