/** What the screen that is open adds to the palette: its commands, and what can be said to it in a sentence. */
import { useEffect } from "react";
import { create } from "zustand";
import type { Target } from "./search";

export interface Offer {
  /** Asked when the palette opens. `other` reads the texts of the language that is not chosen. */
  readonly targets: (other: (key: string) => string) => readonly Target[];
  /** What a sentence means, "add Paint at Oven"; nothing for one that is not understood. */
  readonly said: (query: string, other: (key: string) => string) => readonly Target[];
}

export const useOffers = create<{ readonly offer: Offer | null }>(() => ({ offer: null }));

/** Offer it as long as the screen is there. */
export function useOffer(offer: Offer): void {
  useEffect(() => {
    useOffers.setState({ offer });
    return () => useOffers.setState({ offer: null });
  }, [offer]);
}
