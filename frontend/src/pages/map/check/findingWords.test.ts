import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import type { FloorFinding } from "@/api/types";
import german from "@/i18n/de/screens/floorCheck.json";
import floorCheck from "@/i18n/en/screens/floorCheck.json";
import openapi from "../../../../../docs/openapi.json";
import { findingWords, isError, keyOf, shortBy } from "./findingWords";

beforeAll(() => i18next.init({ lng: "en", resources: { en: { translation: { floorCheck } } } }));

const NAMES: Record<string, string> = { oven: "Curing Oven", dock2: "Dock 2", dock3: "Dock 3", z1: "Spill" };
const FINDING: FloorFinding = {
  code: "too_narrow",
  target: "oven",
  x: 0,
  y: 0,
  other: null,
  width_m: 0.72,
  needs_m: 0.8,
  sides: [
    [0, 0],
    [0.72, 0],
  ],
  beside: [null, "oven"],
};
const wordsOf = (changes: Partial<FloorFinding>) =>
  findingWords({ ...FINDING, ...changes }, (id) => NAMES[id] ?? id, i18next.t);

test("a way that is too narrow is told with what stands beside it and by how much", () => {
  const { title, text } = wordsOf({});
  expect(title).toBe("Curing Oven: the way there is too narrow by 8\u202fcm");
  expect(text).toBe("Between a wall and Curing Oven 0.72\u202fm are free, 0.80\u202fm are needed.");
});

test("two walls, one side and no side have words of their own", () => {
  expect(wordsOf({ beside: [null, null] }).text).toMatch(/^Between walls 0\.72/);
  expect(wordsOf({ beside: ["oven"] }).text).toMatch(/^At Curing Oven 0\.72/);
  expect(wordsOf({ beside: [] }).text).toMatch(/^There 0\.72/);
});

test("what zones do is told by their names, and several without", () => {
  expect(wordsOf({ code: "cut_off", other: "z1" }).text).toBe("The zone Spill shuts the way.");
  expect(wordsOf({ code: "cut_off" }).text).toMatch(/^Several zones/);
});

test("two places are told by both names", () => {
  expect(wordsOf({ code: "together", target: "dock2", other: "dock3" }).title).toBe(
    "Dock 2 and Dock 3: one robot at a time",
  );
  expect(wordsOf({ code: "in_the_way", target: "oven", other: "dock2" }).title).toBe(
    "A robot at Dock 2 keeps others from Curing Oven",
  );
});

test("what may be so is a warning, all else an error", () => {
  const codes: FloorFinding["code"][] = ["keep_out", "together", "in_the_way", "no_way", "too_narrow", "off_lattice"];
  expect(codes.map((code) => isError({ code }))).toEqual([false, false, false, true, true, true]);
});

test("what is short is rounded up, and never nothing", () => {
  expect(shortBy(0.72, 0.8)).toBe("8\u202fcm");
  expect(shortBy(0.721, 0.8)).toBe("8\u202fcm");
  expect(shortBy(0.7999, 0.8)).toBe("1\u202fcm");
});

test("two findings of one target have keys of their own", () => {
  const together = { ...FINDING, code: "together" as const };
  expect(new Set([keyOf(FINDING), keyOf(together), keyOf({ ...together, other: "dock2" })]).size).toBe(3);
});

test("each kind of finding has a title and a text in every language", () => {
  const codes = openapi.components.schemas.FloorFindingShape.properties.code.enum;
  expect(codes.length).toBeGreaterThan(8);
  for (const { title, text } of [floorCheck, german]) {
    expect(Object.keys(title).sort()).toEqual([...codes].sort());
    expect(codes.filter((code) => !(code in text))).toEqual([]);
  }
});
