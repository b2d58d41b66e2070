// @vitest-environment jsdom
import { act, cleanup, renderHook } from "@testing-library/react";
import { afterEach, expect, test, vi } from "vitest";
import { PIXELS_PER_METRE } from "@/map/plane/projection";
import type { StageNode } from "./nodes";
import { useMovingNodes, withTheRest } from "./useMovingNodes";

afterEach(cleanup);

const chips = new Map(["a", "b", "c"].map((id, at) => [id, { at: { x: at * PIXELS_PER_METRE, y: 0 } }]));

test("what is selected and has no node goes as far as what was dragged", () => {
  const moved = [{ id: "a", at: [0.5, -1], pointed: [0.52, -1] }] as const;
  expect(withTheRest(moved, chips, new Set(["a", "b", "gone"]))).toEqual([
    moved[0],
    { id: "b", at: [1.5, -1], pointed: [1.5, -1] },
  ]);
  expect(withTheRest(moved, chips, new Set(["b", "c"]))).toBe(moved);
});

const node = (id: string) => ({ id, type: "step", position: { x: 0, y: 0 }, data: {} }) as unknown as StageNode;

test("of a step that somebody takes away while it is held nothing goes on", () => {
  const [onMove, onDragging] = [vi.fn(), vi.fn()];
  const looks = { selected: new Set<string>() };
  const use = (built: StageNode[]) =>
    useMovingNodes(built, { onMove, onDragging, scene: { chips: new Map() }, looks }, (_id, at) => ({
      at,
      guides: [],
    }));
  const [both, other] = [[node("a"), node("b")], [node("b")]];
  const { result, rerender } = renderHook(use, { initialProps: both });
  const drag = (id: string, x: number) =>
    act(() => {
      result.current.onNodesChange([{ type: "position", id, position: { x, y: 0 }, dragging: true }]);
    });
  drag("a", PIXELS_PER_METRE);
  expect(onDragging).toHaveBeenLastCalledWith({ a: [1, 0] });
  rerender(other);
  expect(onDragging).toHaveBeenLastCalledWith(null);
  drag("a", 2 * PIXELS_PER_METRE);
  expect(onDragging).toHaveBeenLastCalledWith(null);
  // React Flow knows no such node any more.
  act(() => result.current.onDragStop(null, undefined, []));
  expect(onMove).not.toHaveBeenCalled();
  rerender(both);
  expect(result.current.nodes.map(({ position }) => position.x)).toEqual([0, 0]);
  drag("b", PIXELS_PER_METRE);
  expect(onDragging).toHaveBeenLastCalledWith({ b: [1, 0] });
});
