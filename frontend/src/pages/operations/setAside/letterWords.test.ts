import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import type { DeadLetter } from "@/api/types";
import de from "@/i18n/de/screens/operations.json";
import en from "@/i18n/en/screens/operations.json";
import { eventText, isOver, lossWords, whatWords } from "./letterWords";

const LETTER: DeadLetter = {
  id: 1,
  site: "hall",
  run: "r",
  run_number: 7,
  run_status: "paused",
  target: "run",
  event: { type: "answer", device: "oven" },
  error: "KeyError: 'ODD'",
  at: "2026-11-23T12:00:00Z",
  state: "open",
  settled_by: "",
  settled_at: null,
};
const saying = (type: unknown, more: Partial<DeadLetter> = {}) => ({ ...LETTER, event: { type }, ...more });

beforeAll(() =>
  i18next.init({
    lng: "en",
    resources: { de: { translation: { operations: de } }, en: { translation: { operations: en } } },
    interpolation: { escapeValue: false },
  }),
);

test("what could not be taken in is told by whether it was for a run or for the floor", async () => {
  expect(whatWords(LETTER)).toBe("The answer of a device could not be processed.");
  expect(whatWords(saying("answered"))).toBe("The answer of a person could not be processed.");
  expect(whatWords(saying("answered", { target: "floor" }))).toBe("The answer of a device could not be processed.");
  expect(whatWords(saying("plan"))).toBe("The plan or the state of the run cannot be read.");
  await i18next.changeLanguage("de");
  expect(whatWords(saying("run_over", { target: "floor" }))).toBe("Nicht verarbeitet: das Ende des Laufs.");
  await i18next.changeLanguage("en");
});

test("what no version knows is named as it is, and what is no message is said to be none", () => {
  expect(whatWords(saying("nonsense"))).toBe("A message of the kind “nonsense” could not be processed.");
  for (const type of [undefined, 7, null, "unreadable"]) {
    expect(whatWords(saying(type))).toBe("A message that nobody can read came.");
  }
});

test("before it is dropped it is told what is lost, and that a run that is over loses nothing", () => {
  expect(lossWords(LETTER)).toContain("Run 7 never hears of it.");
  expect(lossWords(saying("step"))).toContain("Only this entry goes.");
  expect(lossWords(saying("run_over", { run: null, run_number: null, run_status: null }))).toContain("The floor never");
  const over = { ...LETTER, run_status: "failed" } as const;
  expect([isOver(over), isOver(LETTER)]).toEqual([true, false]);
  expect(lossWords(over)).toBe("Run 7 is over already; it loses nothing.");
});

test("what it says is shown as it is kept", () => {
  expect(eventText(LETTER)).toBe('{\n  "type": "answer",\n  "device": "oven"\n}');
});
