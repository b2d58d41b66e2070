// @vitest-environment jsdom
import { expect, test } from "vitest";
import { startI18n } from "@/i18n";
import { doingWords } from "./doingWords";

test("what is simulated in place of a real device says so", async () => {
  await startI18n();
  expect(doingWords({ activity: null, stand_in: true })).toMatch(/simulated/i);
  expect(doingWords({ activity: null, stand_in: false })).toBe("");
  expect(doingWords({ activity: null })).toBe("");
});
