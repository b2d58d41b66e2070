/** Functions of pasted script that the program has already, line for line. Pure. */
import { inCode, namesIn, renamed } from "./pieces";
import type { Parts } from "./scriptParts";

const OF_SELF = /(?<![\p{ID_Continue}.])self\.(\p{ID_Continue}+)/gu;

/** The functions of a script: its methods but for new_task, run, and those of branches and events. */
export function functionsIn({ methods, inner }: Parts): string[] {
  return [...methods.keys()].filter((name) => name !== "new_task" && name !== "run" && !inner.has(name));
}

/**
 * By which name the program has each pasted function, if it has it: the same, or the one that an earlier paste gave it.
 * `names` are what the pasted names are in the program; what a function calls must be the same, too.
 */
export function sameFunctions(ours: Parts, theirs: Parts, names: ReadonlyMap<string, string>): Map<string, string> {
  const known = new Map(functionsIn(ours).map((name) => [name, bare(wholeOf(ours, name))]));
  const wanted = new Map(calleesFirst(theirs).map((name) => [name, wholeOf(theirs, name)]));
  const left = new Map([...wanted.keys()].map((name) => [name, candidates(name, [...known.keys()])]));
  const now = () => new Map([...names, ...[...left].map(([name, [first]]) => [name, first ?? `?${name}`] as const)]);
  const differs = (name: string, first: string | undefined) =>
    first !== undefined && bare(renamed(wanted.get(name) ?? "", now())) !== known.get(first);
  for (;;) {
    const [, other] = [...left].find(([name, [first]]) => differs(name, first)) ?? [];
    if (!other) break;
    other.shift();
  }
  return new Map([...left].flatMap(([name, [first]]) => (first === undefined ? [] : [[name, first] as const])));
}

function candidates(name: string, known: readonly string[]): string[] {
  const numbered = known.filter((each) => isNumbered(each, name));
  return known.includes(name) ? [name, ...numbered] : numbered;
}

/** Whether a name was made of another one that was taken: `oven_2` of `oven`. */
export function isNumbered(name: string, of: string): boolean {
  return name.startsWith(`${of}_`) && /^\d+$/.test(name.slice(of.length + 1));
}

/** The lines of a method, with those of its branches in place of their names, which are made anew with each print. */
function wholeOf(parts: Parts, name: string, seen = new Set<string>()): string {
  const lines = (parts.methods.get(name) ?? []).join("\n");
  return inCode(lines, (code) =>
    code.replace(OF_SELF, (mention: string, each: string) => {
      if (!parts.inner.has(each) || seen.has(each)) return mention;
      seen.add(each);
      return `{${wholeOf(parts, each, seen).replace(/def \p{ID_Continue}+/u, "def")}}`;
    }),
  );
}

/** Without blank lines, spaces that say nothing, and ways to write a text. */
function bare(text: string): string {
  const lines = text.split("\n").filter((line) => line.trim());
  const tight = (line: string) => inCode(line, (code) => code.replace(/(?:(?<! ) +)?([^\p{ID_Continue} ]) */gu, "$1"));
  return lines
    .map((line) => /^ */.exec(line)?.[0] + tight(line.trim()))
    .join("\n")
    .replace(/'([^'"\\\n]*)'/g, '"$1"');
}

function calleesFirst(parts: Parts): string[] {
  const functions = functionsIn(parts);
  const found = new Set<string>();
  const met = new Set<string>();
  const visit = (name: string) => {
    if (met.has(name)) return;
    met.add(name);
    for (const each of namesIn(wholeOf(parts, name))) if (functions.includes(each)) visit(each);
    found.add(name);
  };
  functions.forEach(visit);
  return [...found];
}
