import { expect, test } from "vitest";
import { fitting, partsOf, wordsOfName } from "./sentence";

const THINGS = [
  { id: "wait", words: ["wait", "warten", "pause"] },
  { id: "cure", words: wordsOfName("curePaint") },
  { id: "move", words: ["move", "fahren", "drive"] },
];
const SPOTS = [
  { id: "oven", words: ["curing", "oven", "ofen"] },
  { id: "mixer", words: ["paint", "mixer", "a"] },
];
const read = (query: string) => {
  const parts = partsOf(query);
  const ids = (words: readonly string[], things: typeof THINGS) => fitting(words, things).map(({ id }) => id);
  return parts && [ids(parts.what, THINGS), parts.where && ids(parts.where, SPOTS)];
};

test("a verb, what, and where, in English and German, with words cut short", () => {
  expect(read("add Paint at Oven")).toEqual([["cure"], ["oven"]]);
  expect(read("Füge Warten am Ofen hinzu")).toEqual([["wait"], ["oven"]]);
  expect(read("neuer Schritt Fahren zu Mix")).toEqual([["move"], ["mixer"]]);
  expect(read("draw the pau near paint mix")).toEqual([["wait"], ["mixer"]]);
});

test("without a place the step goes where the next one goes, and without a verb the place is enough", () => {
  expect(read("add wait")).toEqual([["wait"], null]);
  expect(read("wait at oven")).toEqual([["wait"], ["oven"]]);
});

test("what is no such sentence is not understood", () => {
  expect(read("wait")).toBeNull();
  expect(read("oven")).toBeNull();
  expect(read("add")).toBeNull();
  expect(read("wait at")).toBeNull();
});

test("what nothing is called is told apart from what is not said", () => {
  expect(read("wait at lake")).toEqual([["wait"], []]);
  expect(read("add window at oven")).toEqual([[], ["oven"]]);
});

test("what has a whole word comes before what only begins with it", () => {
  const things = [
    { id: "paints", words: ["paints"] },
    { id: "paint", words: ["paint"] },
  ];
  expect(fitting(["paint"], things).map(({ id }) => id)).toEqual(["paint", "paints"]);
});

test("names of methods are taken apart", () => {
  expect(wordsOfName("curePaint")).toEqual(["cure", "paint"]);
  expect(wordsOfName("open_door_2")).toEqual(["open", "door", "2"]);
});
