/** "add Paint at Oven": what shall be drawn, and where; in both languages, with words cut short. Pure. */
import { wordsOf } from "@/shell/palette/search";

export interface Named {
  readonly id: string;
  /** All words it is known by. */
  readonly words: readonly string[];
}

export interface Parts {
  readonly what: readonly string[];
  /** Null where nothing is said about it. */
  readonly where: readonly string[] | null;
}

const VERBS = [
  "add",
  "draw",
  "insert",
  "make",
  "new",
  "put",
  "fuge",
  "neu",
  "neue",
  "neuen",
  "neuer",
  "zeichne",
  "setze",
];
const ENDS = ["hinzu", "ein", "hinzufugen", "einfugen", "zeichnen"];
const PLACES = ["at", "in", "on", "to", "from", "by", "near", "with"];
const ORTE = ["an", "am", "auf", "bei", "beim", "im", "von", "vom", "zu", "zum", "zur", "mit"];
const ARTICLES = ["a", "an", "the", "step", "ein", "eine", "einen", "der", "die", "das", "dem", "den", "schritt"];

/** The words for what and for where; null for what is no such sentence: neither a verb nor a place is in it. */
export function partsOf(query: string): Parts | null {
  const words = wordsOf(query);
  const verb = VERBS.includes(words[0] ?? "");
  const rest = withoutEnds(verb ? words.slice(1) : words, verb);
  const at = rest.findIndex((word, index) => index > 0 && (PLACES.includes(word) || ORTE.includes(word)));
  if ((!verb && at < 0) || rest.length === 0) return null;
  if (at < 0) return { what: bare(rest), where: null };
  const where = bare(rest.slice(at + 1));
  return where.length === 0 ? null : { what: bare(rest.slice(0, at)), where };
}

function withoutEnds(words: readonly string[], verb: boolean): readonly string[] {
  return verb && ENDS.includes(words.at(-1) ?? "") ? words.slice(0, -1) : words;
}

function bare(words: readonly string[]): readonly string[] {
  const left = words.filter((word) => !ARTICLES.includes(word));
  return left.length > 0 ? left : words;
}

/** Those that each of the words begins a word of; those that have it whole are meant sooner. */
export function fitting<Thing extends Named>(words: readonly string[], things: readonly Thing[]): Thing[] {
  const fits = ({ words: own }: Named) => words.every((word) => own.some((each) => each.startsWith(word)));
  const whole = ({ words: own }: Named) => words.filter((word) => own.includes(word)).length;
  return things
    .filter(fits)
    .map((thing, at) => ({ thing, at }))
    .sort((one, other) => whole(other.thing) - whole(one.thing) || one.at - other.at)
    .map(({ thing }) => thing);
}

/** "curePaint", "cure_paint" → "cure", "paint". */
export function wordsOfName(name: string): string[] {
  return wordsOf(name.replace(/(\p{Ll})(\p{Lu})/gu, "$1 $2").replaceAll("_", " "));
}
