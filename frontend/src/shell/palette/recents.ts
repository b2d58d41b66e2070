/** What a person chose last in the palette, kept in this browser. */

const MOST = 8;

function placeOf(person: string): string {
  return `vipo.recents.${person}`;
}

/** Newest first. */
export function recentsOf(person: string): readonly string[] {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(placeOf(person)) ?? "[]");
    return Array.isArray(kept) ? kept.filter((each) => typeof each === "string") : [];
  } catch {
    return [];
  }
}

export function rememberRecent(person: string, id: string): void {
  const others = recentsOf(person).filter((each) => each !== id);
  localStorage.setItem(placeOf(person), JSON.stringify([id, ...others].slice(0, MOST)));
}
