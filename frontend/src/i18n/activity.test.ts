import i18next from "i18next";
import { beforeEach, expect, test } from "vitest";
import de from "./de/device.json";
import deLate from "./de/screens/device.json";
import { deviceEventWords } from "./deviceEvents";
import { activityWords } from "./activity";
import en from "./en/device.json";
import enLate from "./en/screens/device.json";

beforeEach(() =>
  i18next.init({
    lng: "de",
    resources: {
      de: { translation: { device: { ...de, ...deLate } } },
      en: { translation: { device: { ...en, ...enLate } } },
    },
    interpolation: { escapeValue: false },
  }),
);

const event = (code: string, args: Record<string, unknown>): Parameters<typeof deviceEventWords>[0] => ({
  text: "As it was written",
  code,
  args,
});

test("what a device is doing is said in the language of the screen", async () => {
  const carries = { doing: "Carrying 1 box, 2 cans", activity: { code: "carrying", args: { box: 1, can: 2 } } };
  const has = { doing: "3 boxes", activity: { code: "stock", args: { count: 3, object: "box" } } };
  expect([activityWords(carries), activityWords(has)]).toEqual(["Trägt 1 × box, 2 × can", "3 × box"]);
  await i18next.changeLanguage("en");
  expect([activityWords(carries), activityWords(has)]).toEqual(["Carrying 1 box, 2 cans", "3 boxes"]);
});

test("what a device has in store that gives several things is so many objects", async () => {
  const has = (count: number) => ({ doing: "", activity: { code: "objects", args: { count } } });
  expect([activityWords(has(12)), activityWords(has(1))]).toEqual(["12 Objekte", "1 Objekt"]);
  await i18next.changeLanguage("en");
  expect([activityWords(has(12)), activityWords(has(1))]).toEqual(["12 objects", "1 object"]);
});

test("a device's own words stay as they are, in quotes; an unknown code leaves the server's words", () => {
  expect(activityWords({ doing: "Lid open", activity: { code: "said", args: { text: "Lid open" } } })).toBe(
    "„Lid open“",
  );
  expect(activityWords({ doing: "Dancing", activity: { code: "dancing", args: {} } })).toBe("Dancing");
  expect(activityWords({ doing: "", activity: null })).toBe("");
});

test("a line of a device's history is said in the language of the screen", () => {
  expect(deviceEventWords(event("map", { width: 25, height: 14.4 }))).toBe("Hat seine Karte geschickt: 25 mal 14,4 m");
  expect(deviceEventWords(event("moved", { x: 1.5, y: -2 }))).toBe("Versetzt nach 1,50 / -2,00");
  const parts = [
    { code: "added_method", name: "mix" },
    { code: "stands", x: 1, y: 2 },
  ];
  expect(deviceEventWords(event("described", { parts }))).toBe("Neue Methode mix; gibt an, bei 1,00 / 2,00 zu stehen");
});

test("a line without a code, or with one that the screens do not know, is shown as it was written", () => {
  expect(deviceEventWords(event("", {}))).toBe("As it was written");
  expect(deviceEventWords(event("part", {}))).toBe("As it was written");
  expect(deviceEventWords(event("something_new", {}))).toBe("As it was written");
  expect(deviceEventWords(event("described", { parts: [{ code: "something_new" }] }))).toBe("As it was written");
});
