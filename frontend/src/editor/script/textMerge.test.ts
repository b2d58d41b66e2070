import { expect, test } from "vitest";
import { changesBetween, mergeTexts, sameLines } from "./textMerge";

const BASE = "a\nb\nc\nd\n";

test("what others changed elsewhere comes into my text", () => {
  expect(mergeTexts(BASE, "a\nB\nc\nd\n", "a\nb\nc\nd\ne\n")).toEqual({ text: "a\nB\nc\nd\ne\n", conflicts: [] });
});

test("what both changed alike is no conflict", () => {
  expect(mergeTexts(BASE, "a\nB\nc\nd\n", "a\nB\nc\nd\n")).toEqual({ text: "a\nB\nc\nd\n", conflicts: [] });
});

test("where both changed the same line mine stays, and theirs is told", () => {
  expect(mergeTexts(BASE, "a\nmine\nc\nd\n", "a\ntheirs\nc\nD\n")).toEqual({
    text: "a\nmine\nc\nD\n",
    conflicts: [{ line: 2, theirs: ["theirs"] }],
  });
});

test("where both only add lines, both are kept; what both give in run is given once", () => {
  expect(mergeTexts(BASE, "a\nb\nmine\nc\nd\n", "a\nb\ntheirs\nc\nd\n")).toEqual({
    text: "a\nb\ntheirs\nmine\nc\nd\n",
    conflicts: [],
  });
  const give = '        self.oven = ctx.get("oven01")';
  expect(mergeTexts(BASE, `a\n${give}\nx\nb\nc\nd\n`, `a\ny\n${give}\nb\nc\nd\n`).text).toBe(
    `a\ny\n${give}\nx\nb\nc\nd\n`,
  );
});

function apply(text: string, changes: ReturnType<typeof changesBetween>): string {
  return [...changes]
    .reverse()
    .reduce((now, { from, to, insert }) => now.slice(0, from) + insert + now.slice(to), text);
}

test("changes by lines turn any text into any other", () => {
  const texts = ["", "a", "a\n", "a\nb", "b\na\n", "\n", "\n\n", "a\nb\nc\n", "a\nx\nc", "c\nb", "x\na\nb\nc\ny"];
  for (const before of texts)
    for (const after of texts)
      expect([before, after, apply(before, changesBetween(before, after))]).toEqual([before, after, after]);
});

test("a change in one line leaves the others untouched", () => {
  expect(changesBetween("a\nb\nc\n", "a\nx\nc\n")).toEqual([{ from: 2, to: 4, insert: "x\n" }]);
});

test("lines know their places in the printed script", () => {
  expect(sameLines("a\nb\nc", "a\nnew\n  b\nc")).toEqual([0, -1, 1, 2]);
  expect(sameLines("a\nb\nc", "a\nB\nc")).toEqual([0, 1, 2]);
  expect(sameLines("a\nb\nc", "a\nc")).toEqual([0, 2]);
});
