/** One finger is not two, and what two began is nobody's when the first of them is lifted. */
import { expect, test } from "vitest";
import { FingerCount, useFingers } from "./fingers";

const finger = (pointerId: number) => ({ pointerId, pointerType: "touch" });

test("a second finger gives up what the first began, until all are lifted and one presses anew", () => {
  const count = new FingerCount();
  count.press(finger(1));
  expect(useFingers.getState()).toEqual({ touching: true, several: false });
  count.press(finger(2));
  expect(useFingers.getState()).toEqual({ touching: true, several: true });
  count.lift(finger(1));
  expect(useFingers.getState().several).toBe(true);
  count.lift(finger(2));
  count.press(finger(3));
  expect(useFingers.getState()).toEqual({ touching: true, several: false });
});

test("a mouse is no finger", () => {
  const count = new FingerCount();
  count.press(finger(1));
  count.press({ pointerId: 9, pointerType: "mouse" });
  expect(useFingers.getState()).toEqual({ touching: false, several: false });
});
