/** What of a compiled program is another than before, as the server says it after an edit (docs/shapes/compiled.md). */
import type { Compiled } from "@/api/types";

type Diagnostic = Compiled["diagnostics"][number];
/** At this place of what was, so many items go, and these come. */
type Hunk<T> = readonly [at: number, gone: number, come: readonly T[]];
/** Numbers with this beginning, followed by this count or a higher one, are counted so much further. */
type Shift = readonly [prefix: string, start: number, by: number];
type Changes<T> = Readonly<Record<string, T | null>>;

export interface CompiledPatch {
  readonly base: number;
  readonly revision: number;
  readonly script?: readonly Hunk<string>[];
  readonly lines?: readonly Hunk<string>[];
  readonly order?: readonly Hunk<string>[];
  readonly added_moves?: readonly Hunk<string>[];
  readonly diagnostics?: readonly Hunk<Omit<Diagnostic, "line">>[];
  readonly diagnostic_lines?: readonly Diagnostic["line"][];
  readonly shifts?: readonly Shift[];
  readonly numbers?: Changes<string>;
  readonly depth?: Changes<number>;
}

/** What a patch makes of the form; null where it begins from another one. */
export function applyPatch(before: Compiled, patch: CompiledPatch): Compiled | null {
  if (before.revision !== patch.base) return null;
  const { script, numbers, depth } = patch;
  return {
    revision: patch.revision,
    script: script ? splice(before.script.split("\n"), script).join("\n") : before.script,
    lines: splice(before.lines, patch.lines),
    order: splice(before.order, patch.order),
    added_moves: splice(before.added_moves, patch.added_moves),
    diagnostics: diagnosticsOf(before, patch),
    numbers: numbers ? change(shiftAll(before.numbers, patch.shifts ?? []), numbers) : before.numbers,
    depth: depth ? change(before.depth, depth) : before.depth,
  };
}

function splice<T>(items: T[], hunks: readonly Hunk<T>[] | undefined): T[] {
  if (!hunks) return items;
  let made: T[] = [];
  let at = 0;
  for (const [start, gone, come] of hunks) {
    made = made.concat(items.slice(at, start), come);
    at = start + gone;
  }
  return made.concat(items.slice(at));
}

function diagnosticsOf(before: Compiled, patch: CompiledPatch): Diagnostic[] {
  if (!patch.diagnostics && !patch.diagnostic_lines) return before.diagnostics;
  const found = splice<Omit<Diagnostic, "line">>(before.diagnostics, patch.diagnostics);
  const where = patch.diagnostic_lines ?? before.diagnostics.map(({ line }) => line);
  return found.map((diagnostic, index) => ({ ...diagnostic, line: where[index] ?? null }));
}

function shiftAll(numbers: Readonly<Record<string, string>>, shifts: readonly Shift[]): Record<string, string> {
  const moved = (number: string) => shifts.reduce(shifted, number);
  return Object.fromEntries(Object.entries(numbers).map(([step, number]) => [step, moved(number)]));
}

function shifted(number: string, [prefix, start, by]: Shift): string {
  if (!number.startsWith(prefix)) return number;
  const count = /^\d+/.exec(number.slice(prefix.length))?.[0];
  if (count === undefined || Number(count) < start) return number;
  return `${prefix}${Number(count) + by}${number.slice(prefix.length + count.length)}`;
}

function change<T>(values: Readonly<Record<string, T>>, changes: Changes<T>): Record<string, T> {
  const changed = Object.entries({ ...values, ...changes });
  return Object.fromEntries(changed.filter((entry): entry is [string, T] => entry[1] !== null));
}
