import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import simulation from "@/i18n/de/screens/simulation.json";
import { progressWords } from "./progress";

const course = { virtual_s: 3725, step: "s", steps_done: 2, steps: 5, share: 0.4, end_known: true };

beforeAll(() => i18next.init({ lng: "de", resources: { de: { translation: { simulation } } } }));

test("steps, the step that it is at, and the virtual time", () => {
  expect(progressWords(course, { s: "3.1" })).toBe(
    "2 von 5 Schritten erledigt · jetzt bei Schritt 3.1 · 1:02:05 simulierte Zeit",
  );
});

test("where steps are repeated it says that they were done once, and leaves out a step without a number", () => {
  expect(progressWords({ ...course, end_known: false })).toBe(
    "2 von 5 Schritten mindestens einmal erledigt · 1:02:05 simulierte Zeit",
  );
});
