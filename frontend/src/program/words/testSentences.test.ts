// @vitest-environment jsdom
import { beforeAll, expect, test } from "vitest";
import i18next from "i18next";
import { chooseLanguage, loadScreenTexts, startI18n } from "@/i18n";
import en from "@/i18n/en/screens/tests.json";
import de from "@/i18n/de/screens/tests.json";
import { expectedWords, seenWords, type Expectation } from "./testSentences";

const t = (key: string, values?: Record<string, unknown>) => i18next.t(key, values);
const of = (more: Partial<Expectation>): Expectation => ({
  ...{ expected: "in English", saw: "seen in English", line: 1, ok: true, t_s: null, figure: null },
  ...{ kind: "", says: null, seen: {}, ...more },
});

beforeAll(async () => {
  await startI18n();
  await loadScreenTexts();
});

test("expectations and what was seen are sentences of the screen's language", async () => {
  const slow = of({ kind: "within_s", says: { most_s: 120 }, seen: { code: "took", t_s: 184 } });
  expect(expectedWords(slow, t).text).toBe("ends within 2\u202fmin 0\u202fs");
  expect(seenWords(slow, t).text).toBe("it took 3\u202fmin 4\u202fs");
  await chooseLanguage("de");
  await loadScreenTexts();
  expect(expectedWords(slow, t).text).toBe("endet innerhalb von 2\u202fmin 0\u202fs");
  expect(seenWords(slow, t)).toEqual({ text: "es dauerte 3\u202fmin 4\u202fs" });
  await chooseLanguage("en");
});

test.each([
  ["ends", {}, "ends well"],
  ["fails", { word: "blocked" }, "fails with “blocked”"],
  ["item", { at: "dock", object: "box" }, "dock holds some box at the end"],
  ["item", { at: "dock", object: "box", count: 0 }, "dock holds 0 box at the end"],
  ["never_two_in", { zone: "Aisle", within_m: 1 }, "never two robots in the zone Aisle"],
  ["never_two_in", { place: "dock", within_m: 0.5 }, "never two robots within 0.5 m of dock"],
  ["commands", { commands: ["a.mix", "drop"] }, "commands in this order: a.mix, drop"],
  ["property", { device: "oven", name: "hot", word: "is", value: true }, "oven.hot is true"],
  ["property", { device: "oven", name: "t", word: "at_least", value: 40 }, "oven.t at least 40"],
  ["step", { step: "x", number: "7b" }, "step 7b is carried out"],
  ["step", { step: "x", number: "7b", times: 0 }, "step 7b is carried out 0×"],
])("%s is said", (kind, says, words) => {
  expect(expectedWords(of({ kind, says }), t)).toEqual({ text: words });
});

test("what has no code yet, or one of a newer server, is told in English", () => {
  expect(expectedWords(of({}), t)).toEqual({ text: "in English", lang: "en" });
  expect(expectedWords(of({ kind: "newer", says: {} }), t)).toEqual({ text: "in English", lang: "en" });
  expect(seenWords(of({ seen: { code: "newer" } }), t)).toEqual({ text: "seen in English", lang: "en" });
});

test("both languages have the same sentences", () => {
  for (const part of ["expects", "seen"] as const) expect(Object.keys(de[part])).toEqual(Object.keys(en[part]));
});
