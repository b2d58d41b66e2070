/** What is said to who listens: politely, one sentence after the other, the same one again, too. */
import { create } from "zustand";

interface Said {
  readonly text: string;
  /** Counts up: an equal sentence is another one. */
  readonly turn: number;
}

export const useSaid = create<Said>(() => ({ text: "", turn: 0 }));

export function announce(text: string): void {
  useSaid.setState(({ turn }) => ({ text, turn: turn + 1 }));
}
