// @vitest-environment jsdom
import { act, cleanup, fireEvent, render } from "@testing-library/react";
import { ReactFlowProvider } from "@xyflow/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Position } from "@/program/document/document";
import { useFingers } from "@/program/touch/fingers";
import { Corners, nearestLeg, pushed, withCorner, withoutCorner } from "./Corners";

beforeEach(() => useFingers.setState({ touching: false, several: false }));
afterEach(cleanup);

const SQUARE: readonly Position[] = [
  [0, 0],
  [2, 0],
  [2, -2],
  [0, -2],
];

/** The first corner of a zone, and all that is changed of it. */
function firstCorner(): [Element, (readonly Position[])[]] {
  const changes: (readonly Position[])[] = [];
  const { getByLabelText } = render(
    <ReactFlowProvider>
      <Corners
        points={SQUARE}
        closed
        fewest={3}
        nameOf={(number) => `corner ${number}`}
        nameOfNew={(number) => `new ${number}`}
        onChange={(points) => changes.push(points)}
      />
    </ReactFlowProvider>,
  );
  return [getByLabelText("corner 1"), changes];
}

test("a corner follows the finger that holds it alone", () => {
  const [corner, changes] = firstCorner();
  fireEvent.pointerDown(corner, { pointerId: 1 });
  fireEvent.pointerMove(window, { pointerId: 1, clientX: 46, clientY: 46 });
  fireEvent.pointerMove(window, { pointerId: 2, clientX: 460, clientY: 460 });
  fireEvent.pointerUp(window, { pointerId: 2 });
  expect(changes).toEqual([]);
  fireEvent.pointerUp(window, { pointerId: 1 });
  expect(changes).toEqual([[[1, -1], ...SQUARE.slice(1)]]);
});

test("a second finger gives up what the first one began, and holds no corner itself", () => {
  const [corner, changes] = firstCorner();
  fireEvent.pointerDown(corner, { pointerId: 1 });
  fireEvent.pointerMove(window, { pointerId: 1, clientX: 46, clientY: 46 });
  act(() => useFingers.setState({ touching: true, several: true }));
  fireEvent.pointerDown(corner, { pointerId: 2 });
  for (const pointerId of [1, 2]) {
    fireEvent.pointerMove(window, { pointerId, clientX: 92, clientY: 92 });
    fireEvent.pointerUp(window, { pointerId });
  }
  expect(changes).toEqual([]);
});

test("a double click takes the corner away and asks for nothing else", () => {
  const [corner, changes] = firstCorner();
  const heard = vi.fn();
  window.addEventListener("dblclick", heard);
  fireEvent.doubleClick(corner);
  window.removeEventListener("dblclick", heard);
  expect(changes).toEqual([SQUARE.slice(1)]);
  expect(heard).not.toHaveBeenCalled();
});

test("corners are pushed, added and taken away one at a time", () => {
  const square = [
    [0, 0],
    [1, 0],
    [1, 1],
  ] as const;
  expect(pushed(square, 1, [0.1, -0.2])[1]).toEqual([1.1, -0.2]);
  expect(withCorner(square, 1, [0.5, 0])).toEqual([
    [0, 0],
    [0.5, 0],
    [1, 0],
    [1, 1],
  ]);
  expect(withoutCorner(square, 0)).toEqual([
    [1, 0],
    [1, 1],
  ]);
});

test("a path that is dragged bends on the leg under the pointer", () => {
  const path = [
    { x: 0, y: 0 },
    { x: 100, y: 0 },
    { x: 100, y: 100 },
  ];
  expect([nearestLeg(path, { x: 40, y: 5 }), nearestLeg(path, { x: 95, y: 60 })]).toEqual([0, 1]);
});
