// @vitest-environment jsdom
import { act, cleanup, renderHook } from "@testing-library/react";
import { afterEach, expect, test } from "vitest";
import type { Point } from "@/map/plane/projection";
import { drawn } from "./cells/drawn";
import { rescale } from "./cells/edits";
import { turnQuarter } from "./cells/turning";
import { FIRST_SETTINGS, type ToolName } from "./tools";
import { useEdits } from "./useEdits";

afterEach(cleanup);
const L = drawn("#...", "#...", "##??");
const LINE: readonly Point[] = [
  [0, 0],
  [1, 0],
];
const BOX: readonly Point[] = [
  [0, 0],
  [0.2, 0.2],
];

function measuredOn() {
  const { result } = renderHook(() => useEdits(L));
  const stroke = (tool: ToolName, points: readonly Point[]) =>
    act(() => result.current.finish({ ...FIRST_SETTINGS, tool }, points));
  stroke("box", BOX);
  stroke("measure", LINE);
  expect(result.current.measured).toEqual(LINE);
  return { result, stroke };
}

test("the measured line goes when the map is scaled, turned or cropped, or a change is undone or done again", () => {
  const { result, stroke } = measuredOn();
  const now = () => result.current.edits.now;
  for (const lay of [
    () => result.current.changeLie(rescale(now(), 2)),
    () => result.current.undo(),
    () => result.current.redo(),
    () => result.current.changeLie(turnQuarter(now(), "left")),
  ]) {
    act(lay);
    expect(result.current.measured).toEqual([]);
    stroke("measure", LINE);
  }
  stroke("crop", BOX);
  expect(result.current.measured).toEqual([]);
});

test("it stays while walls are drawn and specks are erased", () => {
  const { result, stroke } = measuredOn();
  stroke("brush", BOX);
  act(() => result.current.change({ ...result.current.edits.now }));
  expect(result.current.measured).toEqual(LINE);
});
