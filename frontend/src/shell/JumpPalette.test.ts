import { expect, test } from "vitest";
import { findTargets, type JumpTarget } from "./JumpPalette";

const target = (name: string, also?: string): JumpTarget => ({ kind: "device", name, also, to: name });
const ALL = [target("Map"), target("Paint order"), target("Mixer A", "paintMixer01"), target("Night paint")];
const names = (query: string) => findTargets(ALL, query).map((each) => each.name);

test("an empty query finds everything in its order", () => {
  expect(names("  ")).toEqual(["Map", "Paint order", "Mixer A", "Night paint"]);
});

test("names that begin with the query come first", () => {
  expect(names("PAINT")).toEqual(["Paint order", "Mixer A", "Night paint"]);
});

test("every word must be found, also in the other name", () => {
  expect(names("paint mixer")).toEqual(["Mixer A"]);
  expect(names("paint night order")).toEqual([]);
});
