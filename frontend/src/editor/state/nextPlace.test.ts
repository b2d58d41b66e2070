import { expect, test } from "vitest";
import { toMetres } from "@/map/plane/projection";
import type { Link } from "@/program/scene/links";
import { openBranchAt } from "./nextPlace";

function link(id: string, to: string | null, end: { x: number; y: number }): Link {
  const into = { parent: "choice", branch: id };
  const points = [{ x: 100, y: 100 }, end];
  return { id, points, word: id, tone: "branch", into, after: null, to, from: "choice" };
}

const LINKS = [
  link("then", null, { x: 100, y: 160 }),
  link("else", null, { x: 100, y: 110 }),
  link("body", "wait", { x: 220, y: 160 }),
];

test("the place of an open branch is its end and what is near", () => {
  expect(openBranchAt(LINKS, toMetres({ x: 110, y: 175 }))?.id).toBe("then");
});

test("of two ends the nearer one takes the step", () => {
  expect(openBranchAt(LINKS, toMetres({ x: 100, y: 134 }))?.id).toBe("else");
});

test("a step that stands well beside an open branch is not taken for its own", () => {
  expect(openBranchAt(LINKS, toMetres({ x: 160, y: 160 }))).toBeNull();
});

test("a branch that has a step is no open place", () => {
  expect(openBranchAt(LINKS, toMetres({ x: 220, y: 160 }))).toBeNull();
});
