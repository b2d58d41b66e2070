/** The lines of a program's script: whose they are, and whether a text is such lines. */

const SCRIPT = /^\s*(self\.\p{ID_Start}|if .*:|while .*:|for .*:|try:|class Task)/u;

export interface Printed {
  readonly script: string;
  /** The step of each line. */
  readonly lines: readonly string[];
}

/** Whether a text may be script: its first line that says something begins like one. */
export function looksLikeScript(text: string): boolean {
  return SCRIPT.test(text.split("\n").find((line) => line.trim() !== "") ?? "");
}

export function indentOf(line: string): number {
  return line.length - line.trimStart().length;
}

/** The lines of a step and of what stands in it: from the first to before the other. */
export function blockOf(
  printed: readonly string[],
  lines: readonly string[],
  step: string,
): { readonly from: number; readonly to: number } | null {
  const from = lines.indexOf(step);
  if (from < 0) return null;
  const indent = indentOf(printed[from] ?? "");
  let to = lines.lastIndexOf(step) + 1;
  while ((printed[to] ?? "").trim() && indentOf(printed[to] ?? "") > indent) to += 1;
  return { from, to };
}

/** The functions of a script, each with its lines. */
export function functionsOf(script: readonly string[]): ReadonlyMap<string, readonly string[]> {
  const found = new Map<string, string[]>();
  let current: string[] | null = null;
  for (const line of script) {
    const name = /^ {4}def (\p{ID_Continue}+)\(/u.exec(line)?.[1];
    if (name) found.set(name, (current = []));
    current?.push(line);
  }
  for (const lines of found.values()) while (lines.at(-1)?.trim() === "") lines.pop();
  return found;
}
