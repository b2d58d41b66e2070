/** Whether two values of documents say the same. Pure. */
import { ownEntry } from "@/design/ownEntry";

/**
 * As JSON, whatever the order of the keys: the server gives each value back in an order of its own. What is undefined
 * is as if it were not there.
 */
export function isSameValue(one: unknown, other: unknown): boolean {
  if (one === other) return true;
  if (typeof one !== "object" || typeof other !== "object" || one === null || other === null) return false;
  if (Array.isArray(one) !== Array.isArray(other)) return false;
  const [mine, theirs] = [one as Record<string, unknown>, other as Record<string, unknown>];
  return [...new Set([...Object.keys(mine), ...Object.keys(theirs)])].every((key) =>
    isSameValue(ownEntry(mine, key), ownEntry(theirs, key)),
  );
}
