import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";
import { standsStill } from "./landing";

const at = (pos: readonly [number, number] | null): ProgramDocument => ({
  ...EMPTY_DOCUMENT,
  steps: { a: { kind: "pick_and_drop", pos, params: {} } },
});

test("only a chip that nobody has moved comes onto its way", () => {
  expect(standsStill(at([1, 2]), "a", [1, 2])).toBe(true);
  expect(standsStill(at([1, 3]), "a", [1, 2])).toBe(false);
  expect(standsStill(at(null), "a", [1, 2])).toBe(false);
  expect(standsStill(EMPTY_DOCUMENT, "a", [1, 2])).toBe(false);
});
