import { expect, test } from "vitest";
import { findTargets, plain, type Target, wordsOf } from "./search";

const target = (name: string, also?: string): Target => ({ id: name, kind: "device", name, also, run: () => {} });
const ALL = [target("Map"), target("Paint order"), target("Mixer A", "paintMixer01"), target("Night paint")];
const names = (query: string, recents: string[] = []) => findTargets(ALL, query, recents).map((each) => each.name);

test("an empty query finds everything in its order, what was used last first", () => {
  expect(names("  ")).toEqual(["Map", "Paint order", "Mixer A", "Night paint"]);
  expect(names("", ["Night paint", "gone", "Mixer A"])).toEqual(["Night paint", "Mixer A", "Map", "Paint order"]);
});

test("names that begin with the query come first, then names with such a word, then other words", () => {
  expect(names("PAINT")).toEqual(["Paint order", "Night paint", "Mixer A"]);
});

test("of those that fit alike, the one that was used last comes first", () => {
  expect(names("m", ["Mixer A"])).toEqual(["Mixer A", "Map"]);
  expect(names("m")).toEqual(["Map", "Mixer A"]);
});

test("every word must be found, also among the other words and inside of them", () => {
  expect(names("paint mixer")).toEqual(["Mixer A"]);
  expect(names("mixer01")).toEqual(["Mixer A"]);
  expect(names("paint night order")).toEqual([]);
});

test("case, accents and dots do not matter", () => {
  expect(plain("Größe à ÖFFNEN")).toBe("grosse a offnen");
  expect(wordsOf("Carry, from-here 100 %")).toEqual(["carry", "from", "here", "100", "%"]);
  expect(findTargets([target("Rückgängig")], "ruck").length).toBe(1);
});
