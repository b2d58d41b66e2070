/** Selected steps as script that people can read, and that any program takes again: a small task of its own. */
import { blockOf, functionsOf, indentOf, type Printed } from "./scriptLines";

const INDENT = 8;
const NAMED = /self\.(\p{ID_Continue}+)/gu;

/**
 * `outer` are the steps that stand in no other selected one, in reading order; what stands in them comes along, and so
 * do the functions that they call and what `run` gives them. Null where the script does not have them, being late.
 */
export function clippedScript(printed: Printed, outer: readonly string[]): string | null {
  const script = printed.script.split("\n");
  const blocks = outer.map((step) => blockOf(script, printed.lines, step));
  if (blocks.length === 0 || blocks.some((block) => block === null)) return null;
  const body = blocks.flatMap((block) => (block ? moved(script.slice(block.from, block.to), INDENT) : []));
  const functions = calledFunctions(script, body);
  const given = givenNames(script, [...body, ...functions.flat()]);
  return [
    "class Task(object):",
    "    def new_task(self):",
    ...body,
    "",
    ...functions.flatMap((lines) => [...lines, ""]),
    "    def run(self, ctx):",
    ...given,
    "        self.new_task()",
    "",
  ].join("\n");
}

function moved(lines: readonly string[], indent: number): string[] {
  const least = Math.min(...lines.filter((line) => line.trim()).map(indentOf));
  return lines.map((line) => (line.trim() ? " ".repeat(indent) + line.slice(least) : ""));
}

/** What is called, and the branches of what is done at once. */
function calledFunctions(script: readonly string[], body: readonly string[]): (readonly string[])[] {
  const all = functionsOf(script);
  const taken = new Map<string, readonly string[]>();
  let left = [...body];
  while (left.length > 0) {
    const names = [...left.join("\n").matchAll(NAMED)].map(([, name]) => name ?? "");
    const fresh = names.filter((name) => !taken.has(name) && name !== "new_task" && all.has(name));
    for (const name of fresh) taken.set(name, all.get(name) ?? []);
    left = fresh.flatMap((name) => [...(all.get(name) ?? [])]);
  }
  return [...taken.values()];
}

/** The lines of run that give a device, a robot or a place to a name that is used. */
function givenNames(script: readonly string[], body: readonly string[]): string[] {
  const used = new Set([...body.join("\n").matchAll(NAMED)].map(([, name]) => name));
  const start = script.findIndex((line) => /^ {4}def run\(/.test(line));
  return script.slice(start + 1).filter((line) => used.has(/^\s*self\.(\p{ID_Continue}+)\s*=/u.exec(line)?.[1] ?? ""));
}
