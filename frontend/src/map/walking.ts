/** From one thing on a map to the next by keyboard: Tab stops at one of them only. */

const WAYS: Readonly<Record<string, (at: number, count: number) => number>> = {
  ArrowRight: (at, count) => (at + 1) % count,
  ArrowDown: (at, count) => (at + 1) % count,
  ArrowLeft: (at, count) => (at + count - 1) % count,
  ArrowUp: (at, count) => (at + count - 1) % count,
  Home: () => 0,
  End: (_, count) => count - 1,
};

/** Give the focus to the next of the buttons among which `element` stands; false for any other key. */
export function walk(element: Element, key: string): boolean {
  const way = WAYS[key];
  const all = [...(element.parentElement?.querySelectorAll<SVGElement>(":scope > [role=button]") ?? [])];
  const at = all.indexOf(element as SVGElement);
  if (!way || at < 0) return false;
  all[way(at, all.length)]?.focus();
  return true;
}
