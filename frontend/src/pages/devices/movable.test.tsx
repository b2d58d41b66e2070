// @vitest-environment jsdom
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { useState } from "react";
import { afterEach, expect, test, vi } from "vitest";
import type { Point } from "@/map/plane/projection";
import { LEAST_DRAG, useDrag } from "./movable";

vi.hoisted(() => {
  // A drawing that is shown as it is, 46 pixels a metre: jsdom lays nothing out.
  Object.assign(globalThis, {
    DOMPoint: class {
      constructor(
        readonly x: number,
        readonly y: number,
      ) {}
      matrixTransform() {
        return this;
      }
    },
  });
  Object.assign(SVGElement.prototype, { getScreenCTM: () => null, setPointerCapture() {} });
});
afterEach(cleanup);

const kept: Point[] = [];

function Thing() {
  const [at, show] = useState<Point>([1, 1]);
  const drag = useDrag({
    at,
    show: ([x, y], by) => show([x + by[0], y + by[1]]),
    keep: () => kept.push(at),
    giveUp: () => show([1, 1]),
  });
  return (
    <svg>
      <g role="button" aria-label={at.map((metres) => metres.toFixed(2)).join(" ")} {...drag} />
    </svg>
  );
}

function dragged(...ways: readonly [kind: "Down" | "Move" | "Up" | "Cancel", x: number, pointerId?: number][]) {
  render(<Thing />);
  const thing = screen.getByRole("button");
  for (const [kind, clientX, pointerId = 1] of ways)
    fireEvent[`pointer${kind}`](thing, { button: 0, clientX, clientY: 0, pointerId, isPrimary: pointerId === 1 });
  return thing.getAttribute("aria-label");
}

test("a hand that trembles moves nothing", () => {
  expect(dragged(["Down", 0], ["Move", LEAST_DRAG - 1], ["Move", -1])).toBe("1.00 1.00");
});

test("what is dragged comes along by as much as the pointer, back to where it was too", () => {
  expect(dragged(["Down", 0], ["Move", 92])).toBe("3.00 1.00");
  cleanup();
  expect(dragged(["Down", 0], ["Move", 92], ["Move", 1])).toBe("1.02 1.00");
});

test("it is kept when it is let go, given up when the browser takes the pointer, and still from then on", () => {
  kept.length = 0;
  expect(dragged(["Down", 0], ["Move", 46], ["Up", 46], ["Move", 92])).toBe("2.00 1.00");
  expect(kept).toEqual([[2, 1]]);
  cleanup();
  expect(dragged(["Down", 0], ["Move", 46], ["Cancel", 46], ["Move", 92])).toBe("1.00 1.00");
  expect(kept).toHaveLength(1);
});

test("a second finger neither takes it over nor lets it go", () => {
  expect(dragged(["Down", 0], ["Down", 9, 2], ["Move", 200, 2], ["Up", 200, 2], ["Move", 46])).toBe("2.00 1.00");
});
