/** Finding by a few letters. */
export interface JumpTarget {
  kind: "page" | "program" | "device";
  name: string;
  /** Another word it is known by. */
  also?: string;
  to: string;
}

/** Those whose name holds every word of the query; names that begin with it come first. */
export function findTargets(targets: readonly JumpTarget[], query: string): JumpTarget[] {
  const wanted = query.trim().toLowerCase();
  const words = wanted.split(/\s+/).filter(Boolean);
  const text = (target: JumpTarget) => `${target.name} ${target.also ?? ""}`.toLowerCase();
  const found = targets.filter((target) => words.every((word) => text(target).includes(word)));
  const begins = (target: JumpTarget) => (target.name.toLowerCase().startsWith(wanted) ? 0 : 1);
  return wanted ? found.sort((a, b) => begins(a) - begins(b)) : found;
}
