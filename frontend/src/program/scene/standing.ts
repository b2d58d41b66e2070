/** Where robots stand, followed in reading order: each branch begins where the steps before it have left them. */
import { ancestors } from "../document/tree";
import type { ProgramDocument } from "../document/document";
import type { Spot } from "../surroundings";

type Places = ReadonlyMap<string, Spot>;

interface Branching {
  readonly head: string;
  readonly atOnce: boolean;
  readonly before: Places;
  readonly ends: Places[];
  branch: string | undefined;
}

export class Standing {
  #now = new Map<string, Spot>();
  readonly #open: Branching[] = [];

  constructor(private readonly document: ProgramDocument) {}

  /** Come to the next step in reading order. */
  begin(id: string): void {
    const around = ancestors(this.document, id);
    for (let last = this.#open.at(-1); last && !around.includes(last.head); last = this.#open.at(-1)) this.#close(last);
    const inside = this.#open.at(-1);
    if (inside) this.#enter(inside, this.#branchOf(id, inside.head));
    const kind = this.document.steps[id]?.kind;
    if (kind === "if" || kind === "parallel")
      this.#open.push({
        head: id,
        atOnce: kind === "parallel",
        before: new Map(this.#now),
        ends: [],
        branch: undefined,
      });
  }

  get(role: string): Spot | undefined {
    return this.#now.get(role);
  }

  set(role: string, at: Spot): void {
    this.#now.set(role, at);
  }

  #branchOf(id: string, head: string): string | undefined {
    const path = [id, ...ancestors(this.document, id)];
    const first = path.find((each) => this.document.steps[each]?.place?.[0] === head);
    return first && this.document.steps[first]?.place?.[1];
  }

  #enter(inside: Branching, branch: string | undefined): void {
    if (branch === inside.branch) return;
    if (inside.branch !== undefined) inside.ends.push(this.#now);
    inside.branch = branch;
    this.#now = new Map(inside.before);
  }

  /** Behind it a robot stands where every branch leaves it; of branches at once, where the only one does that uses it. */
  #close({ atOnce, before, ends, branch }: Branching): void {
    this.#open.pop();
    if (branch !== undefined) ends.push(this.#now);
    if (!atOnce && ends.length < 2) ends.push(before);
    const roles = new Set([...before.keys(), ...ends.flatMap((end) => [...end.keys()])]);
    this.#now = new Map();
    for (const role of roles) {
      const places = ends.map((end) => end.get(role));
      const moved = places.filter((place) => place !== before.get(role));
      const left = moved.length === 0 || (!atOnce && moved.length < places.length) ? places : moved;
      const [first] = left;
      if (first && left.every((place) => place && isSame(place, first))) this.#now.set(role, first);
    }
  }
}

function isSame(one: Spot, other: Spot): boolean {
  return one.at.x === other.at.x && one.at.y === other.at.y;
}
