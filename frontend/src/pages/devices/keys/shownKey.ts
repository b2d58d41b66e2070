/** New keys of devices, each shown this one time, one after the other: none takes another's place. */
import { create } from "zustand";

export interface ShownKey {
  device: string;
  name: string;
  credential: string;
  taken: boolean;
}

/** The first of them is shown, the others wait. */
export const useShownKeys = create((): readonly ShownKey[] => []);
