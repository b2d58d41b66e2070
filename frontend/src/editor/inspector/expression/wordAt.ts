/** The word that begins at a column (counted from 1), or the one sign there; a blank where the line has ended. */
export function wordAt(text: string, column: number): string {
  const rest = text.slice(column - 1);
  return /^[\p{L}\p{N}_.]+/u.exec(rest)?.[0] ?? (rest.charAt(0).trim() || "\u00a0");
}
