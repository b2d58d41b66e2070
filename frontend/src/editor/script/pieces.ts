/** Scripts as they are written by hand: what of them is code and what is text, one statement a line. Pure. */
import { indentOf } from "./scriptLines";

const TEXTS = [
  String.raw`"""(?:\\[\s\S]|(?!""")[^\\])*"""`,
  String.raw`'''(?:\\[\s\S]|(?!''')[^\\])*'''`,
  String.raw`"(?:\\.|[^"\\\n])*"`,
  String.raw`'(?:\\.|[^'\\\n])*'`,
];
const TEXT = new RegExp(String.raw`(?<!\p{ID_Continue})([rRbBfFuU]{0,2})(?:${TEXTS.join("|")})|#[^\n]*`, "gu");
const IN_BRACES = /\{\{|\}\}|\{([^{}]*)\}/g;
const OF_SELF = /(?<![\p{ID_Continue}.])self\.(\p{ID_Continue}+)/gu;
const NAMED = /(?<![\p{ID_Continue}.])(self\.|def )(\p{ID_Continue}+)/gu;

/** A text in quotes. */
export const QUOTED = `(?:"[^"\\n]*"|'[^'\\n]*')`;

/** The script with its code changed; texts stay but for the code in braces of an f-string, and comments are left out. */
export function inCode(script: string, change: (code: string) => string): string {
  let [at, changed] = [0, ""];
  for (const found of script.matchAll(TEXT)) {
    changed += change(script.slice(at, found.index)) + textWith(found[0], found[1], change);
    at = found.index + found[0].length;
  }
  return changed + change(script.slice(at));
}

function textWith(text: string, mark: string | undefined, change: (code: string) => string): string {
  if (mark === undefined) return "";
  if (!/f/i.test(mark)) return text;
  // A text of double quotes has none within.
  const quoted = (code: string) => (text.endsWith('"') ? code.replaceAll('"', "'") : code);
  return text.replace(IN_BRACES, (whole, code?: string) =>
    code === undefined ? whole : `{${quoted(inCode(code, change))}}`,
  );
}

/** The code alone, for looking at it: an empty text stands where a text stood. */
export function codeOf(script: string): string {
  const code: string[] = [];
  inCode(script, (piece) => {
    code.push(piece);
    return "";
  });
  return code.join('""');
}

/** The script with each statement in one line, indented by spaces, without comments and spaces at ends of lines. */
export function tidied(script: string): string {
  let depth = 0;
  const text = inCode(script.replaceAll("\r\n", "\n"), (code) =>
    code.replace(/[([{]|[)\]}]|\\?\n\s*|\t/g, (sign) => {
      if ("([{".includes(sign)) depth += 1;
      else if (")]}".includes(sign)) depth = Math.max(0, depth - 1);
      else if (sign.startsWith("\\") || (depth > 0 && sign.startsWith("\n"))) return " ";
      return sign.replaceAll("\t", "    ");
    }),
  );
  return inCode(`${text}\n`, (code) => code.replace(/(?<! ) +(?=\n)/g, "")).slice(0, -1);
}

/** The script with other names behind `self.` and for its functions. */
export function renamed(script: string, names: ReadonlyMap<string, string>): string {
  return inCode(script, (code) =>
    code.replace(NAMED, (_, before: string, name: string) => before + (names.get(name) ?? name)),
  );
}

/** The names behind `self.`, in the order of their first mention. */
export function namesIn(script: string): string[] {
  return [...new Set([...codeOf(script).matchAll(OF_SELF)].map(([, name = ""]) => name))];
}

/** The same lines at another margin; blank ones are empty. */
export function atMargin(lines: readonly string[], margin: number): string[] {
  const least = Math.min(...lines.filter((line) => line.trim()).map(indentOf));
  return lines.map((line) => (line.trim() ? " ".repeat(margin) + line.slice(least) : ""));
}

/** The methods of a tidied script, however deep it indents them: each with its heading, at the margins of a print. */
export function methodsOf(script: string): Map<string, readonly string[]> {
  const found = new Map<string, readonly string[]>();
  const lines = script.split("\n");
  for (const [at, line] of lines.entries()) {
    const name = /^\s*def (\p{ID_Continue}+)\(/u.exec(line)?.[1];
    if (name === undefined) continue;
    const length = lines.slice(at + 1).findIndex((each) => each.trim() && indentOf(each) <= indentOf(line));
    const body = length < 0 ? lines.slice(at + 1) : lines.slice(at + 1, at + 1 + length);
    const full = body.slice(0, body.findLastIndex((each) => each.trim()) + 1);
    found.set(name, [`    ${line.trim()}`, ...atMargin(full, 8)]);
  }
  return found;
}
