/** Comments that are being written: each outlives the form that shows it, for as long as the page is open. */
import { create } from "zustand";
import { useMe } from "@/api/queries";

const useDrafts = create<{ readonly texts: ReadonlyMap<string, string> }>(() => ({ texts: new Map() }));

export interface Draft {
  readonly text: string;
  /** Something has been written that was neither sent nor given up. */
  readonly isBegun: boolean;
  readonly write: (text: string) => void;
  /** It was sent, or is not wanted; with the text that was sent, what was written since stays. */
  readonly end: (sent?: string) => void;
}

/** What the person who is signed in writes under a name: `program/…`, `run/…`, `thread/…` or `comment/…` with its id. */
export function useDraft(name: string, first = ""): Draft {
  const key = `${useMe().data?.user?.id ?? ""} ${name}`;
  const kept = useDrafts(({ texts }) => texts.get(key));
  return {
    text: kept ?? first,
    isBegun: kept !== undefined,
    write: (text) => useDrafts.setState(({ texts }) => ({ texts: new Map(texts).set(key, text) })),
    end: (sent) =>
      useDrafts.setState(({ texts }) => ({
        texts: new Map([...texts].filter(([each, text]) => each !== key || (sent !== undefined && text !== sent))),
      })),
  };
}
