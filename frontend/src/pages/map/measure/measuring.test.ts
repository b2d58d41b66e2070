import { expect, test } from "vitest";
import {
  aimed,
  cancelled,
  cleared,
  labelMiddle,
  left,
  lengthOf,
  lineOf,
  NOTHING,
  pressed,
  released,
  stepped,
  withEnd,
  type Measuring,
} from "./measuring";

const FAR = 0.15;
const clicked = (measuring: Measuring, x: number, y: number) =>
  released(pressed(measuring, [x, y], [x, y]), [x, y], [x, y], FAR);

test("two clicks make a line, a third begins a new one", () => {
  const one = clicked(NOTHING, 1, 1);
  expect(one.ends).toEqual([[1, 1]]);
  const two = clicked(one, 4, 5);
  expect(two.ends).toEqual([[1, 1], [4, 5]]); // prettier-ignore
  expect(lengthOf(two.ends)).toBe(5);
  expect(clicked(two, 7, 7).ends).toEqual([[7, 7]]);
});

test("between the clicks the line follows the pointer and goes with it", () => {
  const one = clicked(NOTHING, 1, 1);
  expect(lineOf(aimed(one, [1, 3]))).toEqual([[1, 1], [1, 3]]); // prettier-ignore
  expect(lineOf(left(one))).toBeNull();
  expect(lineOf(aimed(NOTHING, [1, 3]))).toBeNull();
  const two = clicked(one, 4, 5);
  expect(lineOf(aimed(two, [9, 9]))).toEqual([[1, 1], [4, 5]]); // prettier-ignore
});

test("a drag makes both ends, a hand that trembles only one", () => {
  const begun = pressed(NOTHING, [1, 1], [0.95, 1]);
  expect(released(begun, [1.1, 1], [0.95, 1], FAR).ends).toEqual([[0.95, 1]]);
  expect(released(begun, [3, 1], [3.05, 1], FAR).ends).toEqual([[0.95, 1], [3.05, 1]]); // prettier-ignore
});

test("the second end is where a finger is lifted", () => {
  const second = pressed(clicked(NOTHING, 1, 1), [2, 1], [2, 1]);
  expect(second.ends).toEqual([[1, 1]]);
  expect(released(second, [2.05, 1], [2.1, 1], FAR).ends).toEqual([[1, 1], [2.1, 1]]); // prettier-ignore
});

test("a press that is taken back leaves no end of its own, and one that began elsewhere means nothing", () => {
  expect(cancelled(pressed(NOTHING, [1, 1], [1, 1]))).toEqual(NOTHING);
  const one = clicked(NOTHING, 1, 1);
  expect(cancelled(pressed(one, [2, 1], [2, 1])).ends).toEqual([[1, 1]]);
  expect(released(one, [5, 5], [5, 5], FAR)).toBe(one);
});

test("keys put ends where the cross-hair aims, and it stays when the line or the pointer goes", () => {
  const one = withEnd(stepped(NOTHING, [1, 1], [1, 1]), [1, 1]);
  const on = stepped(one, [3, 1], [3.1, 1]);
  expect(lineOf(on)).toEqual([[1, 1], [3.1, 1]]); // prettier-ignore
  expect(left(on)).toBe(on);
  expect(cleared(on)).toEqual({ ...NOTHING, cross: [3, 1], aim: [3.1, 1] });
  expect(aimed(on, [5, 5]).cross).toBeNull();
});

test("a length is that from the first point to the last", () => {
  expect(lengthOf([[0, 0], [9, 9], [3, 4]])).toBe(5); // prettier-ignore
  expect(lengthOf([])).toBe(0);
});

const FRAME = { left: 0, top: 0, right: 400, bottom: 300 };

test("the label is above a flat line and beside a steep one, clear of the ends of a short one", () => {
  expect(labelMiddle({ x: 100, y: 100 }, { x: 300, y: 100 }, 1, FRAME)).toEqual({ x: 200, y: 80 });
  expect(labelMiddle({ x: 100, y: 100 }, { x: 100, y: 200 }, 1, FRAME)).toEqual({ x: 146, y: 150 });
  expect(labelMiddle({ x: 100, y: 100 }, { x: 120, y: 110 }, 1, FRAME)).toEqual({ x: 110, y: 80 });
  expect(labelMiddle({ x: 100, y: 100 }, { x: 104, y: 112 }, 1, FRAME)).toEqual({ x: 150, y: 106 });
});

test("it is as near at any zoom", () => {
  expect(labelMiddle({ x: 100, y: 100 }, { x: 300, y: 100 }, 2, null)).toEqual({ x: 200, y: 90 });
});

test("where it would be cut off it is on the other side, or pushed in", () => {
  expect(labelMiddle({ x: 100, y: 5 }, { x: 300, y: 5 }, 1, FRAME)).toEqual({ x: 200, y: 25 });
  expect(labelMiddle({ x: 395, y: 100 }, { x: 395, y: 200 }, 1, FRAME)).toEqual({ x: 349, y: 150 });
  expect(labelMiddle({ x: 0, y: 100 }, { x: 20, y: 100 }, 1, FRAME)).toEqual({ x: 24, y: 80 });
  expect(labelMiddle({ x: 0, y: 300 }, { x: 200, y: 500 }, 1, FRAME).y).toBe(298);
});
