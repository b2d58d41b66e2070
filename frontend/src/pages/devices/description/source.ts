/** Colours for Turtle, JSON, the paper's message and the script: one small tokeniser, no grammar. Pure. */

export type TokenKind = "com" | "str" | "num" | "kw" | "cls" | "fn" | "self" | "";
export interface Token {
  readonly kind: TokenKind;
  readonly text: string;
}
export type Dialect = "turtle" | "json" | "message" | "script";

const RULES: Readonly<Record<Dialect, readonly [TokenKind, string][]>> = {
  turtle: [
    ["com", "(?<=^|\\s)#.*"],
    ["cls", "<[^>\\s]*>"],
    ["str", '"(?:[^"\\\\]|\\\\.)*"(?:@[a-z-]+|\\^\\^[\\w:]+)?'],
    ["kw", "@prefix|@base|\\ba\\b(?=\\s)|\\btrue\\b|\\bfalse\\b"],
    ["fn", "[\\w-]*:[\\w./-]*"],
    ["num", "[-+]?\\d+(?:\\.\\d+)?(?:[eE][-+]?\\d+)?"],
  ],
  json: [
    ["fn", '"(?:[^"\\\\]|\\\\.)*"(?=\\s*:)'],
    ["str", '"(?:[^"\\\\]|\\\\.)*"'],
    ["kw", "\\b(?:true|false|null)\\b"],
    ["num", "[-+]?\\d+(?:\\.\\d+)?(?:[eE][-+]?\\d+)?"],
  ],
  message: [
    ["fn", "^\\s*[A-Za-z_]+(?=:)"],
    ["str", '"(?:[^"\\\\]|\\\\.)*"'],
    ["kw", "\\b(?:True|False)\\b"],
    ["num", "[-+]?\\d+(?:\\.\\d+)?(?:[eE][-+]?\\d+)?"],
  ],
  script: [
    ["com", "#.*"],
    ["str", '"(?:[^"\\\\]|\\\\.)*"'],
    ["kw", "\\b(?:class|def|if|else|elif|while|try|except|as|with|return|and|or|not|in|for|pass|None|True|False)\\b"],
    ["self", "\\b(?:self|ctx)\\b"],
    ["fn", "\\b\\w+(?=\\()"],
    ["num", "\\b\\d+(?:\\.\\d+)?\\b"],
  ],
};

/** The tokens of one line; what no rule knows comes as plain text. */
export function tokenise(line: string, dialect: Dialect): Token[] {
  const rules = RULES[dialect];
  const pattern = new RegExp(rules.map(([, rule]) => `(${rule})`).join("|"), "g");
  const tokens: Token[] = [];
  let at = 0;
  for (const match of line.matchAll(pattern)) {
    if (match.index > at) tokens.push({ kind: "", text: line.slice(at, match.index) });
    const found = match.slice(1).findIndex((group) => group !== undefined);
    tokens.push({ kind: rules[found]?.[0] ?? "", text: match[0] });
    at = match.index + match[0].length;
  }
  if (at < line.length) tokens.push({ kind: "", text: line.slice(at) });
  return tokens;
}
