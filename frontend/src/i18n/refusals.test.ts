import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import refusal from "./de/refusal.json";
import { refusalWords } from "./refusals";

beforeAll(() => i18next.init({ lng: "de", resources: { de: { translation: { refusal } } } }));

test("a refusal to run is told in the language of the screen, with the first error", () => {
  const first = { en: "A value is missing.", de: "Ein Wert fehlt." };
  expect(refusalWords("not_ready", { why: "errors", count: 1, first })).toBe(
    "Das Programm hat einen Fehler und kann nicht ausgeführt werden. Ein Wert fehlt.",
  );
  expect(refusalWords("not_ready", { why: "errors", count: 3, first: {} })).toBe(
    "Das Programm hat 3 Fehler und kann nicht ausgeführt werden.",
  );
});

test("a device that does not fit a parameter is told with what it cannot do", () => {
  const first = { en: "Oven cannot paint.", de: "Oven kann paint nicht." };
  expect(refusalWords("not_ready", { why: "parameter_cannot", name: "machine", device: "Oven", first })).toBe(
    "Das Gerät „Oven“ passt nicht zum Parameter „machine“. Oven kann paint nicht.",
  );
});

test("what the screens do not know is left to the server's own words", () => {
  expect(refusalWords("not_ready", undefined)).toBeNull();
  expect(refusalWords("not_ready", { why: "something new" })).toBeNull();
  expect(refusalWords("no_way", { why: "errors" })).toBeNull();
  expect(refusalWords("not_ready", { why: "constructor" })).toBeNull();
  expect(refusalWords("constructor", {})).toBeNull();
});
