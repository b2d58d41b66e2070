/** What pasted script calls by the names of the program's own things, under names that mean the same there. Pure. */
import type { NamedDevice } from "./completion";
import { RESERVED } from "./names";
import { namesIn, QUOTED, renamed } from "./pieces";
import { functionsIn, isNumbered, sameFunctions } from "./sameFunctions";
import { type Given, isDrawn, meansSame, type Parts, partsOf } from "./scriptParts";

export interface Brought {
  /** The pasted script under names of the program. */
  readonly text: string;
  /** Its methods that the program lacks, each with its heading. */
  readonly methods: ReadonlyMap<string, readonly string[]>;
  readonly events: readonly string[];
  /** What the lines of run are for names that the program does not give. */
  readonly given: ReadonlyMap<string, string>;
}

/**
 * A device, place or zone goes by the name by which the program has the same, else by its own, or by a fresh one where
 * the program has another thing of that name; so do parameters and functions. So each step goes on driving its robot.
 */
export function broughtInto(script: string, pasted: string, devices: readonly NamedDevice[]): Brought {
  const [ours, theirs] = [partsOf(script), partsOf(pasted)];
  const names = namesFor(ours, theirs, namesIn(`${script}\n${pasted}`), devices);
  const text = renamed(pasted, names);
  const { methods, events, inner } = partsOf(text);
  const fresh = new Map(
    [...methods].filter(([name]) => name !== "new_task" && name !== "run" && !ours.methods.has(name)),
  );
  const reached = reachedFrom([...(methods.get("new_task") ?? []), ...events], fresh, inner);
  return {
    text,
    methods: new Map([...fresh].filter(([name]) => reached.has(name))),
    events,
    given: new Map(
      [...theirs.given].map(([before, each]) => {
        const name = names.get(before) ?? before;
        return [name, givenAs(name, each, ours)];
      }),
    ),
  };
}

function namesFor(ours: Parts, theirs: Parts, mentioned: readonly string[], devices: readonly NamedDevice[]) {
  const taken = new Set([...RESERVED, ...mentioned, ...ours.methods.keys(), ...theirs.methods.keys()]);
  const names = new Map<string, string>();
  const give = (name: string, isTaken = ours.given.has(name) || ours.methods.has(name) || ours.variables.has(name)) =>
    names.set(name, isTaken ? freshName(name, taken) : name);
  const isAny = ([, { kind }]: readonly [string, Given]) => kind === "any";
  for (const [name, given] of [...theirs.given].sort((one, other) => Number(isAny(one)) - Number(isAny(other)))) {
    const alike = [...theirs.given].find(([, each]) => isOne(each, given))?.[0] ?? name;
    // Any robot is another one than those that the script has beside it.
    const others = given.kind === "any" ? [...names.values()] : [];
    const same = names.get(alike) ?? sameIn(ours, name, given, devices, others);
    if (same === undefined) give(name);
    else names.set(name, same);
  }
  // What a whole task sets is a variable, which both may have; lines without a task mean what the program has.
  if (theirs.methods.has("new_task"))
    for (const name of theirs.variables)
      if (!theirs.given.has(name))
        give(
          name,
          ours.given.has(name) || ours.methods.has(name) || (ours.locals.has(name) && !ours.variables.has(name)),
        );
  const same = sameFunctions(ours, theirs, names);
  for (const name of [...functionsIn(theirs), ...theirs.inner]) {
    const other = same.get(name);
    if (other === undefined) give(name);
    else names.set(name, other);
  }
  return names;
}

/** Whether two names of a script are of one thing. */
function isOne(one: Given, other: Given): boolean {
  return (
    one === other || (one.id === other.id && one.kind === other.kind && ["get", "place", "zone"].includes(one.kind))
  );
}

/** The name by which the program has what is given to a pasted one; any robot and parameters have to be called alike. */
function sameIn(
  ours: Parts,
  name: string,
  given: Given,
  devices: readonly NamedDevice[],
  others: readonly string[],
): string | undefined {
  const byName = given.kind === "any" || given.kind === "parameter";
  const same = [...ours.given].flatMap(([other, each]) => {
    const isCalled = other === name || (each.kind === given.kind && (!byName || isNumbered(other, name)));
    return isCalled && !others.includes(other) && meansSame(given, each, devices) ? [other] : [];
  });
  return same.includes(name) ? name : same[0];
}

function freshName(name: string, taken: Set<string>): string {
  let number = 2;
  while (taken.has(`${name}_${number}`)) number += 1;
  taken.add(`${name}_${number}`);
  return `${name}_${number}`;
}

/** All functions, and those of the methods of branches and events that something of them begins. */
function reachedFrom(
  lines: readonly string[],
  methods: ReadonlyMap<string, readonly string[]>,
  inner: ReadonlySet<string>,
): ReadonlySet<string> {
  const reached = new Set([...methods.keys()].filter((name) => !inner.has(name)));
  const mentioned = new Set(namesIn(lines.join("\n")));
  // Sets go on with what is added meanwhile.
  for (const name of mentioned) if (inner.has(name)) reached.add(name);
  for (const name of reached)
    for (const each of namesIn((methods.get(name) ?? []).join("\n"))) if (inner.has(each)) reached.add(each);
  return reached;
}

/** What run gives to the name: a parameter is called as it is, and another zone has another id. */
function givenAs(name: string, given: Given, ours: Parts): string {
  const first = (text: string) => given.what.replace(new RegExp(QUOTED), () => `"${text}"`);
  if (given.kind === "parameter") return first(name);
  const ids = new Set([...ours.given.values()].flatMap(({ kind, id }) => (kind === "zone" ? [id] : [])));
  return isDrawn(given) && ids.has(given.id) ? first(freshName(given.id, ids)) : given.what;
}
