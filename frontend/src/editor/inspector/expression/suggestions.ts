/** What may be written next in an expression: names, readings of a device, functions. */

export interface LineName {
  readonly name: string;
  readonly kind: string;
  readonly id: string;
  readonly properties: readonly { readonly name: string; readonly written: string }[];
}

export interface Suggestion {
  readonly label: string;
  readonly kind: string;
  /** What takes the place of the text from `from` to the caret. */
  readonly insert: string;
  readonly from: number;
  /** It takes the place of the whole line. */
  readonly whole?: boolean;
  /** Of a reading: where its current value is found. */
  readonly device: string | null;
  readonly property: string | null;
}

export const FUNCTIONS = [
  "abs",
  "count",
  "distance",
  "len",
  "max",
  "min",
  "nearest",
  "now",
  "nth",
  "point",
  "quantity",
  "round",
  "text",
] as const;

const BEFORE = /(?:([\p{ID_Start}_]\p{ID_Continue}*)\.)?([\p{ID_Start}_]\p{ID_Continue}*)?$/u;
const MOST = 50;

export function suggest(text: string, caret: number, names: readonly LineName[]): readonly Suggestion[] {
  const before = text.slice(0, caret);
  if (insideText(before)) return [];
  const [, owner, word = ""] = BEFORE.exec(before) ?? [];
  const from = caret - word.length;
  if (owner !== undefined)
    return readings(
      names.find((each) => each.name === owner),
      word,
      from,
    );
  if (/[\p{ID_Continue}.]$/u.test(before.slice(0, from))) return [];
  const all = [
    ...names.map((each) => entry(each.name, each.kind, each.name, from)),
    ...FUNCTIONS.map((name) => entry(name, "function", name === "now" ? "now()" : `${name}(`, from)),
  ];
  return fitting(all, word);
}

/** The values to choose from whose beginning is written; all of them while the list has only been opened. */
export function suggestChoices(text: string, choices: readonly string[], all: boolean): readonly Suggestion[] {
  const wanted = text.trim().toLowerCase();
  return choices
    .filter((each) => all || (each.toLowerCase().startsWith(wanted) && each !== text.trim()))
    .map((each) => ({ ...entry(each, "option", each, 0), whole: true }));
}

function readings(owner: LineName | undefined, word: string, from: number): readonly Suggestion[] {
  const all = (owner?.properties ?? []).map((each) => ({
    ...entry(each.written, "reading", each.written, from),
    device: owner?.kind === "device" ? owner.id : null,
    property: each.name,
  }));
  return fitting(all, word);
}

function entry(label: string, kind: string, insert: string, from: number): Suggestion {
  return { label, kind, insert, from, device: null, property: null };
}

/** Those that begin with the word come first; a word that is complete needs no suggestion. */
function fitting(all: readonly Suggestion[], word: string): readonly Suggestion[] {
  const wanted = word.toLowerCase();
  const rank = (each: Suggestion) => each.label.toLowerCase().indexOf(wanted);
  return all
    .filter((each) => rank(each) >= 0 && each.insert !== word)
    .sort((a, b) => Math.min(rank(a), 1) - Math.min(rank(b), 1))
    .slice(0, MOST);
}

/** Within quotation marks nothing is suggested, except in the braces of an f-string. */
function insideText(before: string): boolean {
  let mark = "";
  let braces = false;
  let formatted = false;
  for (let at = 0; at < before.length; at += 1) {
    const character = before.charAt(at);
    if (mark === "") {
      if (character !== '"' && character !== "'") continue;
      mark = character;
      braces = false;
      formatted = /f$/i.test(before.slice(0, at));
    } else if (character === "\\") at += 1;
    else if (character === mark) mark = "";
    else if (formatted && character === "{") braces = true;
    else if (formatted && character === "}") braces = false;
  }
  return mark !== "" && !braces;
}

/** The text with a suggestion taken, and where the caret then stands. */
export function take(text: string, caret: number, chosen: Suggestion): { text: string; caret: number } {
  if (chosen.whole) return { text: chosen.insert, caret: chosen.insert.length };
  const written = text.slice(0, chosen.from) + chosen.insert;
  return { text: written + text.slice(caret), caret: written.length };
}
