/** What looks the same is drawn by one call: things by their look, in the order in which looks come first. */
export function byLook<T>(things: readonly T[], lookOf: (thing: T) => string): [look: string, things: T[]][] {
  const groups = new Map<string, T[]>();
  for (const thing of things) {
    const look = lookOf(thing);
    const group = groups.get(look);
    if (group) group.push(thing);
    else groups.set(look, [thing]);
  }
  return [...groups];
}
