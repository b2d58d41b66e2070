/** Look-ups by a word that comes from outside: the class of a stranger's device, a unit, the name of a method. Pure. */

/** What a table holds under a word; undefined for what only every object has, such as `constructor`. */
export function ownEntry<T>(table: Readonly<Record<string, T>> | null | undefined, word: string): T | undefined {
  return table && Object.hasOwn(table, word) ? table[word] : undefined;
}
