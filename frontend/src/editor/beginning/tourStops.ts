/** The tour of the editor: what it stops at, and where its card stands beside it. */
import { create } from "zustand";

export interface TourStop {
  /** `first.tour.<id>` in the catalogues. */
  readonly id: string;
  readonly target: string;
}

export const TOUR_STOPS: readonly TourStop[] = [
  { id: "map", target: "[data-map]" },
  { id: "tools", target: "main [role=toolbar]" },
  { id: "panel", target: "main aside" },
  { id: "drawer", target: "[data-tour=drawer]" },
  { id: "run", target: "[data-tour=run]" },
];

/** Which stop is shown; null: no tour. */
export const useTour = create<{ readonly at: number | null }>(() => ({ at: null }));

export function leaveTour(): void {
  useTour.setState({ at: null });
}

/** The next stop in a direction whose target is on the screen; null behind the last, the same one before the first. */
export function stopBeside(at: number, by: 1 | -1, isThere: (stop: TourStop) => boolean): number | null {
  for (let next = at + by; next >= 0 && next < TOUR_STOPS.length; next += by) {
    const stop = TOUR_STOPS[next];
    if (stop && isThere(stop)) return next;
  }
  return by > 0 ? null : at;
}

export interface Rectangle {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

const GAP = 14;

/** Where a card stands so that it covers as little as may be of its target and nothing of it is off the screen. */
export function cardSpot(
  target: Rectangle,
  card: { readonly width: number; readonly height: number },
  screen: { readonly width: number; readonly height: number },
): { readonly left: number; readonly top: number } {
  const [right, bottom] = [target.left + target.width, target.top + target.height];
  const clamp = (value: number, most: number) => Math.max(GAP, Math.min(value, most - GAP));
  const middle = {
    left: clamp(target.left + target.width / 2 - card.width / 2, screen.width - card.width),
    top: clamp(target.top + target.height / 2 - card.height / 2, screen.height - card.height),
  };
  if (right + 2 * GAP + card.width <= screen.width) return { ...middle, left: right + GAP };
  if (target.left - 2 * GAP - card.width >= 0) return { ...middle, left: target.left - GAP - card.width };
  if (bottom + 2 * GAP + card.height <= screen.height) return { ...middle, top: bottom + GAP };
  if (target.top - 2 * GAP - card.height >= 0) return { ...middle, top: target.top - GAP - card.height };
  return middle;
}
