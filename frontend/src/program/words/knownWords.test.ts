import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type Step } from "../document/document";
import { surroundingsOf } from "../surroundings";
import { wordsOf } from "./knownWords";
import type { Speaker } from "./stepWords";

test("words are put together once for a step and what they speak of", () => {
  let asked = 0;
  const t = (key: string) => ((asked += 1), key);
  const speaker: Speaker = { document: EMPTY_DOCUMENT, surroundings: surroundingsOf([], []), t };
  const step: Step = { kind: "release", pos: null, params: { role: "robot" } };
  const words = wordsOf(step, speaker);
  const before = asked;
  expect(before).toBeGreaterThan(0);
  expect(
    wordsOf(step, { ...speaker, document: { ...EMPTY_DOCUMENT, steps: { a: step }, roles: EMPTY_DOCUMENT.roles } }),
  ).toBe(words);
  expect(asked).toBe(before);
  wordsOf(step, { ...speaker, document: { ...EMPTY_DOCUMENT, roles: {} } });
  expect(asked).toBeGreaterThan(before);
  expect(wordsOf({ ...step }, speaker)).not.toBe(words);
});
