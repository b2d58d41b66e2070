/** The key that the server has just told: kept for the screen only, until the admin closes it. */
import { create } from "zustand";

export interface ShownKey {
  device: string;
  name: string;
  credential: string;
  taken: boolean;
}

interface ShownKeyStore {
  shown: ShownKey | null;
  show: (key: ShownKey) => void;
  forget: () => void;
}

export const useShownKey = create<ShownKeyStore>()((set) => ({
  shown: null,
  show: (shown) => set({ shown }),
  forget: () => set({ shown: null }),
}));
