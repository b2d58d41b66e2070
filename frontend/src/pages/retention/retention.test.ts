import { expect, test } from "vitest";
import { readDays } from "./retention";

test("days are whole numbers up to a hundred years, and an empty field is the server's setting", () => {
  expect(["", " ", "0", " 30 ", "36500"].map(readDays)).toEqual([null, null, 0, 30, 36500]);
  expect(["36501", "-1", "1.5", "1e3", "ten", "123456"].map(readDays)).toEqual(Array(6).fill(undefined));
});
