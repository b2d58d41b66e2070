// @vitest-environment jsdom
import { beforeEach, expect, test } from "vitest";
import type { SiteMap } from "@/api/types";
import { keepLayers, keptLayers, readLayers, shownMap, USUAL } from "./layers";

beforeEach(() => localStorage.clear());

test("at first all is shown but the heat", () => {
  expect(keptLayers("1")).toEqual({ zones: true, places: true, check: true, heat: false, open: null });
});

test("what a person chose is theirs alone", () => {
  keepLayers("1", { ...USUAL, zones: false, heat: true, open: false });
  expect(keptLayers("1")).toEqual({ zones: false, places: true, check: true, heat: true, open: false });
  expect(keptLayers("2")).toEqual(USUAL);
});

test.each(["", "{", "null", "[]", "7", '{"zones":"no","open":3,"walls":false}'])("of %s nothing is taken", (text) => {
  expect(readLayers(text)).toEqual(USUAL);
});

const map = { version: 3, places: [{ id: "dock" }, { id: "gate" }], zones: [{ id: "aisle" }] } as unknown as SiteMap;

test("a map of which all is shown is the very map", () => {
  expect(shownMap(map, USUAL, null)).toBe(map);
});

test("zones and places go from what is drawn, and the place that was asked for stays", () => {
  expect(shownMap(map, { ...USUAL, zones: false }, null)).toEqual({ ...map, zones: [] });
  expect(shownMap(map, { ...USUAL, places: false }, null)).toEqual({ ...map, places: [] });
  expect(shownMap(map, { ...USUAL, places: false }, "gate").places).toEqual([{ id: "gate" }]);
});
