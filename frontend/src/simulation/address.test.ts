import { expect, test } from "vitest";
import { momentIn, momentWritten } from "./address";

const said = (search: string) => momentIn(new URLSearchParams(search));

test("an address names a moment in seconds; nonsense is the beginning", () => {
  expect([said("t=83.5"), said(""), said("t=soon"), said("t=-4"), said("t=Infinity")]).toEqual([83.5, 0, 0, 0, 0]);
});

test("a moment is written as short as it is of use", () => {
  expect([momentWritten(83.4567), momentWritten(12)]).toEqual(["83.5", "12"]);
});
