/** A person as the server names one: in full, by name only, or not at all. */
export type Named = { name: string; initials?: string } | string | null;

export function nameOf(person: Named): string {
  return typeof person === "string" ? person : (person?.name ?? "");
}
