/** Whom a comment calls: `@` and the name of a member. */
export interface Named {
  readonly id: number;
  readonly name: string;
}

export interface TextPiece {
  readonly text: string;
  /** Whom it names; null for all other text. */
  readonly person: Named | null;
}

/** A text in pieces, of which those that name one of these people say whom; the longest name that fits counts. */
export function piecesOf(text: string, people: readonly Named[]): TextPiece[] {
  const longest = [...people]
    .filter(({ name }) => name !== "")
    .sort((one, other) => other.name.length - one.name.length);
  const pieces: TextPiece[] = [];
  let from = 0;
  for (let at = text.indexOf("@"); at >= 0; at = text.indexOf("@", at + 1)) {
    const person = begins(text, at) ? longest.find(({ name }) => isNamed(text, at + 1, name)) : undefined;
    if (!person) continue;
    if (at > from) pieces.push({ text: text.slice(from, at), person: null });
    from = at + 1 + person.name.length;
    pieces.push({ text: text.slice(at, from), person });
    at = from - 1;
  }
  if (from < text.length) pieces.push({ text: text.slice(from), person: null });
  return pieces;
}

const LETTER = /[\p{L}\p{N}_]/u;

/** An @ within a word is part of an address. */
function begins(text: string, at: number): boolean {
  return at === 0 || !LETTER.test(text.charAt(at - 1));
}

function isNamed(text: string, at: number, name: string): boolean {
  const end = at + name.length;
  return text.slice(at, end).toLowerCase() === name.toLowerCase() && !LETTER.test(text.charAt(end));
}

/** The ids of those whom a text names; all who have the same name. */
export function mentionedIn(text: string, people: readonly Named[]): number[] {
  const names = new Set(piecesOf(text, people).flatMap(({ person }) => person?.name.toLowerCase() ?? []));
  return people.filter(({ name }) => names.has(name.toLowerCase())).map(({ id }) => id);
}

export interface Asked {
  /** Where the @ stands. */
  readonly from: number;
  readonly letters: string;
}

const MOST_LETTERS = 40;

/** What is being typed after an @ before the caret, in at most two words; null where nobody is asked for. */
export function askedAt(text: string, caret: number): Asked | null {
  const from = text.lastIndexOf("@", caret - 1);
  if (from < 0 || !begins(text, from)) return null;
  const letters = text.slice(from + 1, caret);
  if (letters.length > MOST_LETTERS || /\n|\s\S*\s/.test(letters) || letters.startsWith(" ")) return null;
  return { from, letters };
}

const MOST_OFFERED = 6;

/** Those whose name, or a word of it, begins with the letters. */
export function offered({ letters }: Asked, people: readonly Named[]): Named[] {
  const wanted = letters.toLowerCase();
  const fits = ({ name }: Named) => {
    const whole = name.toLowerCase();
    return whole !== wanted && (whole.startsWith(wanted) || whole.split(/\s+/).some((word) => word.startsWith(wanted)));
  };
  return people.filter(fits).slice(0, MOST_OFFERED);
}

/** The text with the person's name in place of what was typed, and where the caret is then. */
export function withName(text: string, { from, letters }: Asked, { name }: Named): { text: string; caret: number } {
  const after = text.slice(from + 1 + letters.length);
  const named = `${text.slice(0, from)}@${name}${after.startsWith(" ") ? "" : " "}`;
  return { text: named + after, caret: from + name.length + 2 };
}
