/** Names as a script has them: letters of any language, as Python takes them. Pure. */

/** Words that Python keeps for itself, of small letters. */
const PYTHONS_OWN = new Set(
  (
    "and as assert async await break case class continue def del elif else except finally for from global if import " +
    "in is lambda match nonlocal not or pass raise return try while with yield"
  ).split(" "),
);
const OF_SCRIPTS = /^(branch_|when_e\d)/u;

/**
 * What a task has itself, and what templates call their robot: nothing else has such a name behind `self.`. The first
 * ones are `RESERVED_ATTRIBUTES` of the server.
 */
export const RESERVED: ReadonlySet<string> = new Set(
  "ask call end new_task notify parallel parameters release repeat run set wait zone robot fail limit".split(" "),
);

/**
 * The Python name that VIPO makes of a name, as `snake_case` of the server does (`names.json` holds both to it):
 * `Painting Machine` and `paintingMachine` are `painting_machine`, `Ofen Süd` is `ofen_süd`.
 */
export function pythonName(name: string): string {
  // Python's Unicode is older than browsers': dots between katakana and invisible joiners are not in its names.
  const words = split(asRead(name)).toLowerCase().normalize("NFKC");
  const bare = words
    .replace(/\P{ID_Continue}|\u200C|\u200D|\u30FB|\uFF65/gu, "_")
    .replace(/_+/g, "_")
    .replace(/^_|_$/g, "");
  if (!bare) return "unnamed";
  const begun = /^\p{ID_Start}/u.test(bare) ? bare : `n${bare}`.normalize("NFKC");
  const own = OF_SCRIPTS.test(begun) ? `the_${begun}` : begun;
  return PYTHONS_OWN.has(own) ? `${own}_` : own;
}

/** A name as Python reads it: of letters that are written in several ways, one way. */
function asRead(name: string): string {
  return name.normalize("NFKC");
}

/** A name with `_` where a word begins with a capital: `curePaint`, `RFIDReader`. */
function split(name: string): string {
  const letters = [...name];
  const begins = (letter: string, at: number) => {
    const [before = "", after = ""] = [letters[at - 1], letters[at + 1]];
    if (at === 0 || !isUpper(letter)) return false;
    return isLower(before) || isDigit(before) || (isUpper(before) && isLower(after));
  };
  return letters.map((letter, at) => (begins(letter, at) ? `_${letter}` : letter)).join("");
}

const isUpper = (letter: string) => /^\p{Uppercase}$/u.test(letter);
const isLower = (letter: string) => /^\p{Lowercase}$/u.test(letter);
const isDigit = (letter: string) => /^\p{Nd}$/u.test(letter);
