/** A walk around the editor in five stops, which can be left at any of them. */
import { lazy, Suspense, useEffect } from "react";
import { leaveTour, TOUR_STOPS, useTour } from "./tourStops";

const TourCard = lazy(async () => ({ default: (await import("./TourCard")).TourCard }));

export function Tour() {
  const at = useTour((tour) => tour.at);
  useEffect(() => leaveTour, []);
  const stop = at === null ? undefined : TOUR_STOPS[at];
  // Each stop is a card of its own, so that it takes the focus and is read out.
  return at !== null && stop ? (
    <Suspense fallback={null}>
      <TourCard key={at} at={at} stop={stop} />
    </Suspense>
  ) : null;
}
