/** Fractional keys: strings over 0-9A-Za-z that sort bytewise, so that a step goes between two others. */

const DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
const LAST = DIGITS.length - 1;

/** A key after `before` and before `after`; null stands for the open end. */
export function keyBetween(before: string | null, after: string | null): string {
  if (before !== null && after !== null && before >= after) return keyBetween(before, null);
  return between(before ?? "", after);
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
