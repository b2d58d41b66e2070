/** Two scripts line by line, the same lines beside each other. Pure. */
import { diffIndices } from "node-diff3";
import type { Compiled } from "@/program/document/document";

export interface ScriptLine {
  /** Counted from 1. */
  readonly line: number;
  readonly text: string;
  /** The step that the line belongs to; empty where it belongs to none. */
  readonly step: string;
  readonly number: string;
}

export interface LinePair {
  readonly old: ScriptLine | null;
  readonly new: ScriptLine | null;
  readonly same: boolean;
}

type Script = Pick<Compiled, "script" | "lines" | "numbers">;

export function linePairs(old: Script, next: Script): LinePair[] {
  const [before, after] = [linesOf(old), linesOf(next)];
  const pairs: LinePair[] = [];
  let [left, right] = [0, 0];
  const both = (until: number) => {
    while (left < until) pairs.push({ old: before[left++] ?? null, new: after[right++] ?? null, same: true });
  };
  const differing = diffIndices(
    before.map((line) => line.text),
    after.map((line) => line.text),
  );
  for (const { buffer1, buffer2 } of differing) {
    both(buffer1[0]);
    for (let at = 0; at < Math.max(buffer1[1], buffer2[1]); at++)
      pairs.push({
        old: at < buffer1[1] ? (before[left++] ?? null) : null,
        new: at < buffer2[1] ? (after[right++] ?? null) : null,
        same: false,
      });
  }
  both(before.length);
  return pairs;
}

function linesOf({ script, lines, numbers }: Script): ScriptLine[] {
  const texts = script.replace(/\n$/, "").split("\n");
  return texts.map((text, index) => {
    const step = lines[index] ?? "";
    return { line: index + 1, text, step, number: numbers[step] ?? "" };
  });
}

/** How many lines came and went. */
export function countLines(pairs: readonly LinePair[]): { added: number; removed: number } {
  const differing = pairs.filter((pair) => !pair.same);
  return {
    added: differing.filter((pair) => pair.new).length,
    removed: differing.filter((pair) => pair.old).length,
  };
}
