/** The tour goes on where something is to be seen, and its card stays on the screen. */
import { expect, test } from "vitest";
import { cardSpot, stopBeside, TOUR_STOPS } from "./tourStops";

const everywhere = () => true;

test("the tour goes from stop to stop, ends behind the last and stays at the first", () => {
  const walk = [0];
  for (let next: number | null = 0; next !== null;) {
    next = stopBeside(next, 1, everywhere);
    if (next !== null) walk.push(next);
  }
  expect(walk).toEqual(TOUR_STOPS.map((_, index) => index));
  expect(stopBeside(0, -1, everywhere)).toBe(0);
  expect(stopBeside(3, -1, everywhere)).toBe(2);
});

test("a stop that is not on the screen is left out", () => {
  const withoutPanel = ({ id }: { id: string }) => id !== "panel";
  expect(stopBeside(1, 1, withoutPanel)).toBe(3);
  expect(stopBeside(3, -1, withoutPanel)).toBe(1);
});

test("the card stands right of its target, else left, below, above, else upon it", () => {
  const [card, screen] = [
    { width: 320, height: 180 },
    { width: 1600, height: 1000 },
  ];
  expect(cardSpot({ left: 12, top: 64, width: 48, height: 600 }, card, screen)).toEqual({ left: 74, top: 274 });
  expect(cardSpot({ left: 1276, top: 64, width: 312, height: 600 }, card, screen)).toEqual({ left: 942, top: 274 });
  expect(cardSpot({ left: 0, top: 0, width: 1600, height: 52 }, card, screen)).toEqual({ left: 640, top: 66 });
  expect(cardSpot({ left: 0, top: 724, width: 1600, height: 276 }, card, screen)).toEqual({ left: 640, top: 530 });
  expect(cardSpot({ left: 0, top: 52, width: 1600, height: 948 }, card, screen)).toEqual({ left: 640, top: 436 });
});

test("the card never leaves the screen", () => {
  const spot = cardSpot(
    { left: 0, top: 0, width: 40, height: 40 },
    { width: 320, height: 180 },
    { width: 340, height: 600 },
  );
  expect(spot).toEqual({ left: 14, top: 54 });
});
