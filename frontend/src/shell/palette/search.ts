/** What is found for a few letters: pure, so that every page finds alike. */
import type { ComponentType } from "react";

export const TARGET_KINDS = [
  "command",
  "construct",
  "step",
  "device",
  "place",
  "function",
  "program",
  "run",
  "person",
  "page",
] as const;
export type TargetKind = (typeof TARGET_KINDS)[number];

/** Somewhere to go, or something to do. */
export interface Target {
  /** The same whenever it is offered: recents know it by this. */
  readonly id: string;
  readonly kind: TargetKind;
  readonly name: string;
  /** Other words it is known by: synonyms, its name in the other language, an id. */
  readonly also?: string;
  /** A second line: what it does, or where it is. */
  readonly detail?: string;
  readonly icon?: ComponentType<{ size?: number }>;
  readonly keys?: string;
  /** Why it cannot be done now, as a sentence. */
  readonly whyNot?: string | null;
  readonly run: () => void;
}

/** Lower case without accents; German umlauts are found with and without their dots. */
export function plain(text: string): string {
  return text
    .toLowerCase()
    .replaceAll("ß", "ss")
    .normalize("NFD")
    .replace(/\p{Mn}/gu, "");
}

export function wordsOf(text: string): string[] {
  return plain(text)
    .split(/[^\p{L}\p{N}%]+/u)
    .filter(Boolean);
}

/**
 * Those that have every word of the query, best first: a name that begins with the query, then names with words that
 * begin so, then those known by other words. Of equal ones those that were used last come first.
 */
export function findTargets(targets: readonly Target[], query: string, recents: readonly string[] = []): Target[] {
  const words = wordsOf(query);
  if (words.length === 0) return recentFirst(targets, recents);
  const rated = targets.flatMap((target, at) => {
    const rank = rankOf(target, plain(query.trim()), words);
    return rank === null ? [] : [{ target, rank, recent: rankOfRecent(recents, target.id), at }];
  });
  rated.sort((one, other) => one.rank - other.rank || one.recent - other.recent || one.at - other.at);
  return rated.map(({ target }) => target);
}

/** Without a query: what was used last, then all in their order. */
function recentFirst(targets: readonly Target[], recents: readonly string[]): Target[] {
  const byId = new Map(targets.map((each) => [each.id, each]));
  const first = recents.flatMap((id) => byId.get(id) ?? []);
  return [...first, ...targets.filter(({ id }) => !recents.includes(id))];
}

function rankOfRecent(recents: readonly string[], id: string): number {
  const at = recents.indexOf(id);
  return at < 0 ? recents.length : at;
}

function rankOf({ name, also = "" }: Target, query: string, words: readonly string[]): number | null {
  const own = plain(name);
  if (own === query) return 0;
  if (own.startsWith(query)) return 1;
  const parts = wordsOf(name);
  if (words.every((word) => parts.some((part) => part.startsWith(word)))) return 2;
  const others = wordsOf(also);
  const known = (word: string) => [...parts, ...others].some((part) => part.startsWith(word));
  if (words.every(known)) return 3;
  const all = `${own} ${plain(also)}`;
  return words.every((word) => all.includes(word)) ? 4 : null;
}
