import { expect, test } from "vitest";
import { boxAt, overlaps } from "@/program/scene/geometry";
import { aligned, moveBy, shifted, spread, type Standing, tidied } from "./arranging";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";

const at = (id: string, x: number, y: number, width = 100, height = 30): Standing => ({
  id,
  box: boxAt({ x, y }, width, height),
});
const THREE = [at("a", 100, 100), at("b", 260, 140, 60), at("c", 600, 90)];

test("steps are aligned at the outermost of their edges, or at the middle between them", () => {
  const lefts = shifted(THREE, aligned(THREE, "left")).map(({ box }) => box.left);
  expect(lefts).toEqual([50, 50, 50]);
  const rights = shifted(THREE, aligned(THREE, "right")).map(({ box }) => box.right);
  expect(rights).toEqual([650, 650, 650]);
  const middles = shifted(THREE, aligned(THREE, "middle")).map(({ box }) => (box.top + box.bottom) / 2);
  expect(middles).toEqual([115, 115, 115]);
  expect(aligned(THREE, "top").get("c")).toEqual({ x: 0, y: 0 });
});

test("spread steps have the same gaps, and the outermost stay", () => {
  const after = shifted(THREE, spread(THREE, "across")).map(({ box }) => box);
  expect([after[0]?.left, after[2]?.right]).toEqual([50, 650]);
  expect((after[1]?.left ?? 0) - (after[0]?.right ?? 0)).toBe((after[2]?.left ?? 0) - (after[1]?.right ?? 0));
  expect(after.map((box) => box.top)).toEqual(THREE.map(({ box }) => box.top));
});

test("tidy steps stand in their order and cover none of each other", () => {
  const order = shifted(THREE, tidied(THREE)).map(({ box }) => box);
  expect(order.every((box, index) => index === 0 || box.left > (order[index - 1]?.right ?? 0))).toBe(true);
  expect(new Set(order.map((box) => (box.top + box.bottom) / 2)).size).toBe(1);
  const many = Array.from({ length: 9 }, (_, index) => at(`s${index}`, index * 3, index * 7));
  const cells = shifted(many, tidied(many)).map(({ box }) => box);
  expect(cells.some((box, index) => cells.some((other, j) => j > index && overlaps(box, other)))).toBe(false);
  expect(new Set(cells.map((box) => box.top)).size).toBe(3);
});

test("what stands in a step moves with it, and what moves less than a pixel stays", () => {
  const step = (kind: Step["kind"], pos: Step["pos"], parent: string): Step => {
    return { kind, pos, place: [parent, "body", "a"], params: {} };
  };
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    steps: {
      loop: step("repeat", [1, 1], "program"),
      inner: step("wait", [1, 0], "loop"),
      other: step("wait", [5, 5], "program"),
    },
  };
  const shifts = new Map([
    ["loop", { x: 46, y: 23 }],
    ["other", { x: 0.2, y: 0 }],
  ]);
  expect(moveBy(document, shifts)).toEqual([
    { do: "set_pos", id: "loop", pos: [2, 0.5] },
    { do: "set_pos", id: "inner", pos: [2, -0.5] },
  ]);
});
