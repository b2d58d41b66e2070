import { expect, test } from "vitest";
import { wordBox, wordPlace } from "./links";

const down = [
  { x: 100, y: 0 },
  { x: 100, y: 80 },
];
const right = [
  { x: 0, y: 50 },
  { x: 80, y: 50 },
];

test("a word stands beside a steep arrow and over a flat one", () => {
  expect(wordPlace({ points: down })).toEqual({ x: 108, y: 28, anchor: "start" });
  expect(wordPlace({ points: right })).toEqual({ x: 24, y: 43, anchor: "middle" });
});

test("on a short arrow it stands half way", () => {
  expect(
    wordPlace({
      points: [
        { x: 0, y: 0 },
        { x: 0, y: 20 },
      ],
    })?.y,
  ).toBe(14);
});

test("only an arrow with a word keeps room for it", () => {
  expect(wordBox({ points: down, word: null })).toBeNull();
  const box = wordBox({ points: down, word: "true" });
  expect([box?.left, box?.top, box?.bottom]).toEqual([108, 17, 32]);
});
