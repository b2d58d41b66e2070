import { expect, test } from "vitest";
import type { ProgramDocument } from "../document/document";
import { readTree } from "../document/tree";
import type { Chip } from "./chips";
import { clearHeads, framesOf } from "./frames";
import { boxAt } from "./geometry";

const DOCUMENT = {
  steps: {
    try: { kind: "try", place: ["program", "body", "1V"], params: {} },
    carry: { kind: "wait", place: ["try", "body", "1V"], params: {} },
  },
  functions: {},
} as unknown as ProgramDocument;

function chip(id: string, shape: string, x: number, y: number, width: number): Chip {
  const at = { x, y };
  return { id, shape, at, width, height: 28, box: boxAt(at, width, 28) } as Chip;
}

const drawn = (headWidth: number, stepX = 140, stepY = 0) =>
  new Map([
    ["try", chip("try", "header", 0, 0, headWidth)],
    ["carry", chip("carry", "pill", stepX, stepY, 100)],
  ]);

test("a head whose words reach its first step makes room to the left, and the frame goes around both", () => {
  const chips = drawn(240);
  const tree = readTree(DOCUMENT);
  clearHeads(DOCUMENT, tree, chips);
  expect(chips.get("try")?.box.right).toBe((chips.get("carry")?.box.left ?? 0) - 8);
  expect(framesOf(DOCUMENT, tree, chips).get("try")?.box.left).toBe((chips.get("try")?.box.left ?? 0) - 10);
});

test("a head that covers nothing stays, and so does one whose step lies left of it", () => {
  for (const chips of [drawn(120), drawn(240, 140, 60), drawn(240, -140)]) {
    const before = chips.get("try");
    clearHeads(DOCUMENT, readTree(DOCUMENT), chips);
    expect(chips.get("try")).toBe(before);
  }
});
