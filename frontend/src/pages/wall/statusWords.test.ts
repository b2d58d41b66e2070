// @vitest-environment jsdom
import { beforeAll, expect, test } from "vitest";
import { loadScreenTexts, startI18n } from "@/i18n";
import { formatMoment, formatTime } from "@/i18n/format";
import { statusWords } from "./statusWords";

beforeAll(async () => {
  await startI18n();
  await loadScreenTexts();
});

const at = (day: number, hour: number) => new Date(2026, 10, day, hour).toISOString();
const now = new Date(2026, 10, 30, 4).getTime();

test("of a run that is planned for today the time is said, of one for another day the day as well", () => {
  expect(statusWords({ status: "pending", not_before: at(30, 6) }, now)).toBe(`Begins at ${formatTime(at(30, 6))}`);
  expect(statusWords({ status: "pending", not_before: at(37, 6) }, now)).toBe(`Begins on ${formatMoment(at(37, 6))}`);
});

test("of any other run it is said how it is", () => {
  expect(statusWords({ status: "pending", not_before: null }, now)).toBe("Starts soon");
  expect(statusWords({ status: "running", not_before: at(29, 6) }, now)).toBe("Running");
});
