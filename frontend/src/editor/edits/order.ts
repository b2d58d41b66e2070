/** Fractional keys: strings over 0-9A-Za-z that sort bytewise, so that a step goes between two others. */

import { compareBytes } from "@/program/document/outline";

const DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
const LAST = DIGITS.length - 1;

/** A key after `before` and before `after`; null stands for the open end. */
export function keyBetween(before: string | null, after: string | null): string {
  if (before !== null && after !== null && before >= after) return keyBetween(before, null);
  return between(before ?? "", after);
}

/** So many keys in a row between the two; null where there is no room, as between two equal keys. */
export function keysBetween(before: string | null, after: string | null, count: number): string[] | null {
  const keys: string[] = [];
  for (let last = before; keys.length < count;) {
    const key = keyInRoom(last, after);
    if (key === null) return null;
    keys.push(key);
    last = key;
  }
  return keys;
}

/** Keys that others wrote may hold any signs; a longer one always follows. */
function keyInRoom(before: string | null, after: string | null): string | null {
  const ordered = before === null || after === null || compareBytes(before, after) < 0;
  const candidates = ordered ? [between(before ?? "", after), `${before ?? ""}V`] : [];
  return candidates.find((key) => liesBetween(key, before, after)) ?? null;
}

function liesBetween(key: string, before: string | null, after: string | null): boolean {
  return compareBytes(key, before ?? "") > 0 && (after === null || compareBytes(key, after) < 0);
}

function between(low: string, high: string | null): string {
  if (high === null) return above(low);
  const same = commonPrefix(low, high);
  if (same > 0) return high.slice(0, same) + between(low.slice(same), high.slice(same));
  const from = low ? digit(low) : 0;
  const to = digit(high);
  if (to - from > 1) return at(Math.round((from + to) / 2));
  if (high.length > 1) return high.slice(0, 1);
  return at(from) + above(low.slice(1));
}

/** The next key at the open end: one digit on, so that many appended steps keep short keys. */
function above(low: string): string {
  if (!low) return at(Math.round(LAST / 2));
  const first = digit(low);
  return first < LAST ? at(first + 1) : at(LAST) + above(low.slice(1));
}

/** How far the two agree, a missing digit of the lower one counting as the lowest digit. */
function commonPrefix(low: string, high: string): number {
  let same = 0;
  while (same < high.length && (low[same] ?? DIGITS[0]) === high[same]) same += 1;
  return same;
}

function digit(key: string): number {
  return Math.max(0, DIGITS.indexOf(key.slice(0, 1)));
}

function at(index: number): string {
  return DIGITS.charAt(index);
}
