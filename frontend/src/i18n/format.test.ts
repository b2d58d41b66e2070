import i18next from "i18next";
import { beforeEach, expect, test, vi } from "vitest";
import {
  formatAge,
  formatAgo,
  formatClock,
  formatNumber,
  formatPoint,
  formatReading,
  formatSpan,
  formatTimeOfDay,
  withUnit,
} from "./format";
import { UNIT_CHOICES, unitSign } from "./units";
import TABLE from "./units.json";

const NOW = Date.parse("2026-01-10T12:00:00Z");
const before = (seconds: number) => new Date(NOW - seconds * 1000).toISOString();
/** Thin spaces shown as `_`. */
const thin = (text: string) => text.replaceAll("\u202f", "_");

beforeEach(async () => {
  await i18next.init({ lng: "en", resources: {} });
});

test("numbers follow the language", async () => {
  expect(formatNumber(1234.5, 1)).toBe("1,234.5");
  await i18next.changeLanguage("de");
  expect(formatNumber(1234.5, 1)).toBe("1.234,5");
});

test("small readings are told with the figures that they have, and none is a zero with a sign", async () => {
  const told = [0.04, -0.0004, 1.5708, 62.34567, 22.5, 87, 1013.25, 123456, -0, 3.21e-7].map(formatReading);
  expect(told).toEqual(["0.04", "-0.0004", "1.571", "62.35", "22.5", "87", "1,013.3", "123,456", "0", "3.21E-7"]);
  await i18next.changeLanguage("de");
  expect(formatReading(-0.0004)).toBe("-0,0004");
});

test("the numbers of a place can be told apart in every language", async () => {
  expect(formatPoint(2.2, -1.95)).toBe("2.20, -1.95");
  await i18next.changeLanguage("de");
  expect(formatPoint(2.2, -1.95)).toBe("2,20 / -1,95");
});

test("a unit stands behind a thin space, no unit behind nothing", () => {
  expect(thin(withUnit("62", "°C"))).toBe("62_°C");
  expect(withUnit("62", "")).toBe("62");
});

test("a unit that nobody knows stays as it is, whatever it is called", () => {
  expect(["DEG_C", "FURLONG", "constructor"].map(unitSign)).toEqual(["°C", "FURLONG", "constructor"]);
});

test("spans name at most two units", () => {
  expect([0, 59.6, 66, 3600, 7320].map((seconds) => thin(formatSpan(seconds)))).toEqual([
    "0_s",
    "1_min 0_s",
    "1_min 6_s",
    "1_h 0_min",
    "2_h 2_min",
  ]);
});

test("a clock shows hours only when there are some", () => {
  expect([0, 65.9, 738, 3738].map(formatClock)).toEqual(["0:00", "1:05", "12:18", "1:02:18"]);
});

test("relative time takes the unit that fits, in both languages", async () => {
  expect([5, 120, 7200, 86_400, 20 * 86_400].map((seconds) => formatAgo(before(seconds), NOW))).toEqual([
    "5 seconds ago",
    "2 minutes ago",
    "2 hours ago",
    "yesterday",
    "3 weeks ago",
  ]);
  await i18next.changeLanguage("de");
  expect(formatAgo(before(120), NOW)).toBe("vor 2 Minuten");
});

test("an age has tenths below ten seconds and whole minutes from one on", () => {
  expect([0.42, 14, 130, 7260].map((seconds) => thin(formatAge(before(seconds), NOW)))).toEqual([
    "0.4_s",
    "14_s",
    "2_min",
    "2_h 1_min",
  ]);
});

test("what happened after the last look at the clock is now", () => {
  expect(formatAgo(before(-12), NOW)).toBe("now");
});

test("an age is never negative, whatever the clocks say", () => {
  expect(thin(formatAge(before(-30), NOW))).toBe("0.0_s");
});

test("units are shown as people read them, strange ones as they come", () => {
  expect(["DEG_C", "PERCENT", "REV-PER-MIN", "MilliBAR", "UNITLESS", "furlong", ""].map(unitSign)).toEqual([
    "°C",
    "%",
    "rpm",
    "mbar",
    "",
    "furlong",
    "",
  ]);
});

test("no unit, and what is no text, is shown as none", () => {
  const brought: unknown[] = [null, undefined, 7, { a: 1 }];
  expect(brought.map((each) => unitSign(each as string))).toEqual(["", "", "", ""]);
});

test("each unit can be chosen once, the common ones first", () => {
  const values = UNIT_CHOICES.map(({ value }) => value);
  expect(new Set(values).size).toBe(values.length);
  expect(values.slice(0, 3)).toEqual(["SEC", "MIN", "HR"]);
  expect(values.toSorted()).toEqual(Object.keys(TABLE).toSorted());
  expect(UNIT_CHOICES.filter(({ label }) => !label)).toEqual([]);
});

test("a time of day is written as the language has it, in whatever zone the browser is", async () => {
  vi.stubGlobal("navigator", { languages: ["en-GB", "de-DE"] });
  expect(formatTimeOfDay(370)).toBe("06:10");
  await i18next.changeLanguage("de");
  expect([370, 0, 1430].map(formatTimeOfDay)).toEqual(["06:10", "00:00", "23:50"]);
});
