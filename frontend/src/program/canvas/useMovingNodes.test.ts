import { expect, test } from "vitest";
import { PIXELS_PER_METRE } from "@/map/plane/projection";
import { withTheRest } from "./useMovingNodes";

const chips = new Map(["a", "b", "c"].map((id, at) => [id, { at: { x: at * PIXELS_PER_METRE, y: 0 } }]));

test("what is selected and has no node goes as far as what was dragged", () => {
  const moved = [{ id: "a", at: [0.5, -1], pointed: [0.52, -1] }] as const;
  expect(withTheRest(moved, chips, new Set(["a", "b", "gone"]))).toEqual([
    moved[0],
    { id: "b", at: [1.5, -1], pointed: [1.5, -1] },
  ]);
  expect(withTheRest(moved, chips, new Set(["b", "c"]))).toBe(moved);
});
