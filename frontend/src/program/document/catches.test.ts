/** The catches of a Try: which there are, and what adds and removes one. */
import { expect, test } from "vitest";
import { knownNames } from "@/editor/edits/variables";
import { takeApart } from "@/editor/edits/branches";
import { takenBy } from "../words/catchWords";
import { addedCatch, catchesOf, isCatch, kindsOf, removedCatch } from "./catches";
import { EMPTY_DOCUMENT, type Step } from "./document";

const step = (kind: string, place: Step["place"], params: Step["params"] = {}): Step => ({
  kind,
  place,
  pos: [0, 0],
  params,
});

test("a catch is there by its own parameter; old documents have the first", () => {
  expect(catchesOf({})).toEqual(["catch"]);
  expect(catchesOf({ catch: false })).toEqual([]);
  expect(catchesOf({ catch: false, kinds: ["failed"], kinds2: [] })).toEqual(["catch2"]);
  expect(catchesOf({ kinds3: [], kinds2: null, kinds9: [], kinds4: "failed" })).toEqual(["catch", "catch3"]);
});

test("the branches that may be catches, with their parameters", () => {
  expect(["catch", "catch2", "catch8", "catch1", "catch9", "body", undefined].map(isCatch)).toEqual([
    ...[true, true, true],
    ...[false, false, false, false],
  ]);
  expect([kindsOf("catch"), kindsOf("catch2")]).toEqual(["kinds", "kinds2"]);
});

test("one more stands behind the others; in a gap only when there is no number left", () => {
  expect(addedCatch({ catch: false })).toEqual(["catch", null]);
  expect(addedCatch({})).toEqual(["kinds2", []]);
  expect(addedCatch({ kinds2: null, kinds3: [] })).toEqual(["kinds4", []]);
  expect(addedCatch({ catch: false, kinds8: [] })).toEqual(["catch", null]);
  expect(addedCatch({ kinds2: [], kinds8: [] })).toEqual(["kinds3", []]);
  const all = Object.fromEntries([2, 3, 4, 5, 6, 7, 8].map((number) => [`kinds${number}`, []]));
  expect(addedCatch(all)).toBeNull();
});

test("what removes a catch takes it away and leaves the others", () => {
  const params = { kinds: ["failed"], kinds2: ["offline"], kinds3: [] };
  const without = (branch: string) => catchesOf({ ...params, ...Object.fromEntries([removedCatch(branch)]) });
  expect(["catch", "catch2", "catch3"].map(without)).toEqual([
    ["catch2", "catch3"],
    ["catch", "catch3"],
    ["catch", "catch2"],
  ]);
});

test("several catches are called by what they take", () => {
  const t = (key: string) => key.replace("caught.", "");
  const several = step("try", null, { kinds: [], kinds2: ["offline"], kinds3: ["failed", "blocked"], kinds4: [] });
  const words = ["catch", "catch2", "catch3", "catch4", "finally"].map((branch) => takenBy(branch, several, t));
  expect(words).toEqual(["any", "offline", "failed +1", "rest", null]);
  expect(takenBy("catch", step("try", null, { kinds: ["failed"] }), t)).toBeNull();
});

test("a step in a further catch knows the problem, and is a draft when the Try is taken apart", () => {
  const steps = {
    head: step("try", ["program", "body", "A"], { kinds: ["failed"], kinds2: [] }),
    tell: step("notify", ["head", "catch2", "A"]),
    work: step("wait", ["head", "body", "A"]),
  };
  const document = { ...EMPTY_DOCUMENT, steps };
  const problem = (id: string) => knownNames(document, id).some(({ name }) => name === "problem.kind");
  expect([problem("tell"), problem("work")]).toEqual([true, false]);
  expect(takeApart(document, "head")).toMatchObject({
    edits: expect.arrayContaining([{ do: "set_place", id: "tell", place: null }]) as unknown,
  });
});
