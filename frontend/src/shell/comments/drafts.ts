/** Comments that are being written: each outlives the form that shows it, for as long as the page is open. */
import { create } from "zustand";
import { useMe } from "@/api/queries";

interface Drafts {
  readonly texts: ReadonlyMap<string, string>;
  /** Those that are on their way to the server. */
  readonly sending: ReadonlySet<string>;
}

const useDrafts = create<Drafts>(() => ({ texts: new Map(), sending: new Set() }));

export interface Draft {
  readonly text: string;
  /** Something has been written that was neither sent nor given up. */
  readonly isBegun: boolean;
  readonly write: (text: string) => void;
  readonly isSending: boolean;
  /**
   * Send it, unless it is on its way already, from whatever form: then nothing is sent, and false comes back. What is
   * written meanwhile stays. Rejects as `post` does; then all of it stays.
   */
  readonly send: (post: () => Promise<unknown>) => Promise<boolean>;
  /** It is not wanted. */
  readonly giveUp: () => void;
}

/** What the person who is signed in writes under a name: `program/…`, `run/…`, `thread/…` or `comment/…` with its id. */
export function useDraft(name: string, first = ""): Draft {
  const key = `${useMe().data?.user?.id ?? ""} ${name}`;
  const kept = useDrafts(({ texts }) => texts.get(key));
  const isSending = useDrafts(({ sending }) => sending.has(key));
  return {
    text: kept ?? first,
    isBegun: kept !== undefined,
    write: (text) => useDrafts.setState(({ texts }) => ({ texts: new Map(texts).set(key, text) })),
    isSending,
    send: async (post) => {
      if (useDrafts.getState().sending.has(key)) return false;
      useDrafts.setState(({ sending }) => ({ sending: new Set([...sending, key]) }));
      try {
        await post();
        end(key, (text) => text === (kept ?? first));
        return true;
      } finally {
        useDrafts.setState(({ sending }) => ({ sending: new Set([...sending].filter((each) => each !== key)) }));
      }
    },
    giveUp: () => end(key, () => true),
  };
}

function end(key: string, isOver: (text: string) => boolean): void {
  useDrafts.setState(({ texts }) => ({
    texts: new Map([...texts].filter(([each, text]) => each !== key || !isOver(text))),
  }));
}
