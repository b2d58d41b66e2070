/** The new key that is shown, of one device at a time. */
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
