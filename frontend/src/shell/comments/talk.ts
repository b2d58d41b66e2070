/** Where one talks: the program whose comments these are, what one may do there, and where a refusal is told. */
import { createContext, useContext } from "react";
import type { Site } from "@/api/types";

export interface Talk {
  readonly program: string;
  readonly role: Site["role"];
  readonly tell: (refusal: string) => void;
}

export const TalkContext = createContext<Talk | null>(null);

export function useTalk(): Talk {
  const talk = useContext(TalkContext);
  if (!talk) throw new Error("Comments need a TalkContext around them.");
  return talk;
}
