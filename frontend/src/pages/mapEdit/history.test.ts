import { expect, test } from "vitest";
import { drawn } from "./cells/drawn";
import { begin, change, redo, undo } from "./history";

const [FIRST, SECOND, THIRD] = [drawn("."), drawn("#"), drawn("?")];

test("what was done is taken back step by step and done again; another change ends that", () => {
  const two = change(change(begin(FIRST), SECOND), THIRD);
  const back = undo(undo(two));
  expect([back.now, redo(back).now, redo(redo(back)).now]).toEqual([FIRST, SECOND, THIRD]);
  expect(undo(back).now).toBe(FIRST);
  const other = change(undo(two), FIRST);
  expect([redo(other).now, undo(other).now]).toEqual([FIRST, SECOND]);
});

test("the same map is no change", () => {
  const edits = begin(FIRST);
  expect(change(edits, FIRST)).toBe(edits);
});

test("of large maps fewer steps are kept, and one at least", () => {
  const huge = (mark: number) => ({ ...FIRST, width: mark, cells: new Uint8Array(60_000_000) });
  let edits = begin(huge(1));
  for (const mark of [2, 3, 4, 5]) edits = change(edits, { ...edits.now, width: mark });
  expect(edits.past.map(({ width }) => width)).toEqual([3, 4]);
  const vast = { ...FIRST, cells: new Uint8Array(160_000_000) };
  expect(change(begin(vast), FIRST).past).toEqual([vast]);
});
