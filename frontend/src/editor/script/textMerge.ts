/** Texts by lines: merged three ways, and compared. */
import { diff3Merge, diffIndices } from "node-diff3";

export interface Merged {
  readonly text: string;
  /** What somebody else wrote where my own text stayed; empty: nothing met. */
  readonly conflicts: readonly Conflict[];
}

export interface Conflict {
  /** The line of my text, from 1. */
  readonly line: number;
  readonly theirs: readonly string[];
}

const GIVEN = /^\s*self\.\p{ID_Continue}+ = ctx\./u;

/** Bring what they changed since `base` into my text; where both changed the same lines, the preferred ones stay.
 * Where both only added lines, theirs come before mine. */
export function mergeTexts(base: string, mine: string, theirs: string, prefer: "mine" | "theirs" = "mine"): Merged {
  const lines: string[] = [];
  const conflicts: Conflict[] = [];
  for (const region of diff3Merge(linesOf(mine), linesOf(base), linesOf(theirs), { excludeFalseConflicts: true })) {
    if (region.ok) lines.push(...region.ok);
    if (region.conflict && region.conflict.o.length === 0) {
      const { a, b } = region.conflict;
      lines.push(...b.filter((line) => !(GIVEN.test(line) && a.includes(line))), ...a);
    } else if (region.conflict) {
      conflicts.push({ line: lines.length + 1, theirs: region.conflict.b });
      lines.push(...(prefer === "mine" ? region.conflict.a : region.conflict.b));
    }
  }
  return { text: lines.join("\n"), conflicts };
}

export interface TextChange {
  readonly from: number;
  readonly to: number;
  readonly insert: string;
}

/** The changes that turn one text into another, by lines, so that a cursor elsewhere stays. */
export function changesBetween(before: string, after: string): readonly TextChange[] {
  const [old, now] = [linesOf(before), linesOf(after)];
  const starts = [0];
  for (const line of old) starts.push((starts.at(-1) ?? 0) + line.length + 1);
  const start = (line: number) => Math.min(starts[line] ?? before.length, before.length);
  return diffIndices(old, now).map(({ buffer1: [first, length], buffer2Content }) => {
    const atEnd = first + length >= old.length;
    const text = buffer2Content.join("\n");
    if (!atEnd) return { from: start(first), to: start(first + length), insert: text && `${text}\n` };
    const from = first === 0 ? 0 : start(first) - (length === 0 && first === old.length ? 0 : 1);
    const lead = first === 0 ? "" : buffer2Content.length > 0 ? "\n" : "";
    return { from, to: before.length, insert: `${lead}${text}` };
  });
}

/** For each line of `mine`, the place of the same line in `printed`, or -1; lines only indented otherwise count. */
export function sameLines(printed: string, mine: string): readonly number[] {
  const trim = (text: string) => linesOf(text).map((line) => line.trim());
  const [theirs, own] = [trim(printed), trim(mine)];
  const places: number[] = [];
  let next = 0;
  for (const { buffer1, buffer2 } of diffIndices(theirs, own)) {
    while (places.length < buffer2[0]) places.push(next++);
    for (let index = 0; index < buffer2[1]; index += 1)
      places.push(buffer1[1] === buffer2[1] ? buffer1[0] + index : -1);
    next = buffer1[0] + buffer1[1];
  }
  while (places.length < own.length) places.push(next++);
  return places;
}

function linesOf(text: string): string[] {
  return text.split("\n");
}
