import { expect, test } from "vitest";
import { countLines, linePairs } from "./lines";

const script = (lines: readonly [text: string, step: string][], numbers: Record<string, string> = {}) => ({
  script: lines.map(([text]) => `${text}\n`).join(""),
  lines: lines.map(([, step]) => step),
  numbers,
});

test("the same lines stand beside each other, others beside nothing", () => {
  const old = script(
    [
      ["a", "s1"],
      ["b", "s2"],
      ["c", ""],
    ],
    { s1: "1", s2: "2" },
  );
  const next = script(
    [
      ["a", "s1"],
      ["x", "s3"],
      ["y", "s3"],
      ["c", ""],
    ],
    { s1: "1", s3: "2" },
  );
  const pairs = linePairs(old, next);
  expect(pairs.map((pair) => [pair.old?.text ?? null, pair.new?.text ?? null, pair.same])).toEqual([
    ["a", "a", true],
    ["b", "x", false],
    [null, "y", false],
    ["c", "c", true],
  ]);
  expect(pairs.map((pair) => pair.new?.line ?? null)).toEqual([1, 2, 3, 4]);
  expect([pairs[1]?.old?.number, pairs[1]?.new?.step]).toEqual(["2", "s3"]);
  expect(countLines(pairs)).toEqual({ added: 2, removed: 1 });
});

test("each line of both scripts is shown once, in its order", () => {
  const texts = (seed: number) =>
    Array.from({ length: 60 }, (_, at) => [`line ${(at * seed) % 17}`, ""] as [string, string]);
  const [old, next] = [script(texts(5)), script(texts(7))];
  const pairs = linePairs(old, next);
  const joined = (side: "old" | "new") =>
    pairs.flatMap((pair) => (pair[side] ? [`${pair[side].text}\n`] : [])).join("");
  expect([joined("old"), joined("new")]).toEqual([old.script, next.script]);
  expect(pairs.every((pair) => pair.same === (pair.old?.text === pair.new?.text && pair.old !== null))).toBe(true);
});
