/** What others change in the program, said politely: one sentence for all of a few seconds. */
import { useEffect, useRef } from "react";
import { useTranslation } from "react-i18next";
import type { ProgramDocument } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import type { OpenProgram } from "../state/context";
import { announce } from "./announcer";

export interface Difference {
  readonly added: readonly string[];
  readonly removed: readonly string[];
  readonly changed: readonly string[];
}

/** Which steps are another; unchanged ones are the same objects, since a document is only changed where it differs. */
export function stepsChanged(before: ProgramDocument, after: ProgramDocument): Difference {
  const [old, now] = [Object.keys(before.steps), Object.keys(after.steps)];
  const same = (id: string) => isSameValue(before.steps[id], after.steps[id]);
  return {
    added: now.filter((id) => !before.steps[id]),
    removed: old.filter((id) => !after.steps[id]),
    changed: now.filter((id) => before.steps[id] && before.steps[id] !== after.steps[id] && !same(id)),
  };
}

export function sentences(
  difference: Difference,
  who: string,
  nameOf: (step: string) => string,
  say: (key: string, values: Record<string, unknown>) => string,
): string {
  return (["added", "removed", "changed"] as const)
    .filter((what) => difference[what].length > 0)
    .map((what) => {
      const ids = difference[what];
      return say(`access.others.${what}`, {
        who,
        count: ids.length,
        step: what === "removed" ? "" : nameOf(ids[0] ?? ""),
      });
    })
    .join(" ");
}

const AT_MOST_EVERY_MS = 5000;

/** Listens to what comes from elsewhere; one's own edits are seen and said where they are made. */
export function useOthersEdits(open: OpenProgram): void {
  const { t } = useTranslation();
  const now = useRef({ open, t });
  useEffect(() => {
    now.current = { open, t };
  });
  const { shared } = open;
  useEffect(() => {
    let { loaded } = shared.getSaving();
    let own = shared.getDocument();
    let waiting: Difference | null = null;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const speak = () => {
      timer = undefined;
      if (!waiting) return;
      announce(wordsFor(now.current.open, waiting, (key, values) => now.current.t(key, values)));
      waiting = null;
      timer = setTimeout(speak, AT_MOST_EVERY_MS);
    };
    const hear = (_update: unknown, origin: unknown) => {
      const before = own;
      own = shared.getDocument();
      if (origin !== shared.provider || !loaded) return;
      const difference = stepsChanged(before, own);
      if (Object.values(difference).every((ids: readonly string[]) => ids.length === 0)) return;
      waiting = waiting ? joined(waiting, difference) : difference;
      timer ??= setTimeout(speak, 0);
    };
    // What the program was before this person had it is nobody's edit.
    const stop = shared.subscribeSaving(() => {
      if (loaded === shared.getSaving().loaded) return;
      loaded = shared.getSaving().loaded;
      own = shared.getDocument();
    });
    shared.doc.on("update", hear);
    return () => {
      stop();
      shared.doc.off("update", hear);
      clearTimeout(timer);
    };
  }, [shared]);
}

function joined(one: Difference, other: Difference): Difference {
  const both = (what: keyof Difference) => [...new Set([...one[what], ...other[what]])];
  const added = both("added");
  return { added, removed: both("removed"), changed: both("changed").filter((id) => !added.includes(id)) };
}

/** By name where only one other person is here. */
function wordsFor(
  open: OpenProgram,
  difference: Difference,
  say: (key: string, values: Record<string, unknown>) => string,
) {
  const names = [...new Set(open.people.filter((each) => !each.me).map(({ name }) => name))];
  const who = names.length === 1 ? (names[0] ?? "") : say("access.others.somebody", {});
  const { t, document, compiled } = open;
  const nameOf = (id: string) => `${compiled?.numbers[id] ?? ""} ${t(`kind.${document.steps[id]?.kind ?? ""}`)}`.trim();
  return sentences(difference, who, nameOf, say);
}
