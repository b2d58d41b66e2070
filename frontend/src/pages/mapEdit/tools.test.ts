import { expect, test } from "vitest";
import { drawn, letters } from "./cells/drawn";
import { applyStroke, FIRST_SETTINGS, strokeOn, TOOLS } from "./tools";

const tool = (name: string) => {
  const found = TOOLS.find((each) => each.name === name);
  if (!found) throw new Error(`There is no tool ${name}.`);
  return found;
};

test("each tool has a key of its own", () => {
  expect(new Set(TOOLS.map(({ key }) => key)).size).toBe(TOOLS.length);
});

test("the brush keeps its way, the others their ends; Shift keeps a line straight, but no box", () => {
  expect(strokeOn(tool("brush"), [[0, 0], [1, 1]], [2, 0], true)).toEqual([[0, 0], [1, 1], [2, 0]]); // prettier-ignore
  expect(strokeOn(tool("line"), [[0, 0], [1, 1]], [3, 1], true)).toEqual([[0, 0], [3, 0]]); // prettier-ignore
  expect(strokeOn(tool("line"), [[0, 0]], [1, 3], true)).toEqual([[0, 0], [0, 3]]); // prettier-ignore
  expect(strokeOn(tool("box"), [[0, 0]], [1, 3], true)).toEqual([[0, 0], [1, 3]]); // prettier-ignore
  expect(strokeOn(tool("line"), [], [1, 3], true)).toEqual([[1, 3]]);
});

test("a stroke does what its tool is for; measuring and panning change nothing", () => {
  const map = drawn("#...", "....", "....", "....");
  const across = [[0.5, 0.5], [3.5, 0.5]] as const; // prettier-ignore
  const after = (name: "line" | "box" | "brush" | "crop") =>
    letters(applyStroke(map, { ...FIRST_SETTINGS, tool: name }, across));
  expect(after("line")).toEqual(["#...", "....", "....", "####"]);
  expect(after("box")).toEqual(["#...", "....", "....", "####"]);
  expect(letters(applyStroke(map, { ...FIRST_SETTINGS, tool: "brush" }, [[0.5, 3.5]]))).toEqual([
    "....",
    "....",
    "....",
    "....",
  ]);
  expect(after("crop")).toEqual(["#...", "....", "....", "...."]);
  for (const name of ["pan", "measure"] as const)
    expect(applyStroke(map, { ...FIRST_SETTINGS, tool: name }, across)).toBe(map);
});
